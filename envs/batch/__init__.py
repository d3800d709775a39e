"""Worlds that are stepped together, and what can be kept of their games."""
