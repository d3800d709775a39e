"""Colliders: the six classes, and the records of them that kernels read."""
