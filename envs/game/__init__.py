"""The rules of the game as kernels: what one tick does to one world."""
