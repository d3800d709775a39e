"""Worlds that live: bodies that come, go and change, each at the cost of its surroundings."""
