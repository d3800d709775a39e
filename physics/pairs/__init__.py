"""What two shapes do to each other: an algorithm a file, and the one table that chooses it."""
