"""What bodies do to each other when they meet: two of them, or many at the same time."""
