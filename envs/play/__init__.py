"""The game in a window, played by hand or shown."""
