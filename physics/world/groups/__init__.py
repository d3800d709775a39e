"""Bodies that meet at the same time, and are resolved together."""
