"""Prioritised level replay: the training chooses the levels from which it can learn most."""
