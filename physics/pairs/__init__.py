"""How two shapes collide: one file per algorithm, and the one table that chooses among them."""
