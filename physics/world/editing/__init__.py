"""Bodies that come, go and change between two steps, each at the cost of its surroundings."""
