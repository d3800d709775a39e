"""Bodies that pages show: two and all that the engine says of them, or a world of many."""
