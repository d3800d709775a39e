"""The collision engine. It knows no game."""
