"""The memory of worlds, as Python holds it: blocks that kernels step, with room, and snapshots."""
