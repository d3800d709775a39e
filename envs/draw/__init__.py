"""Pictures of a world, drawn by kernels without a display."""
