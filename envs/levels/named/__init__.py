"""The named rounds, as text."""
