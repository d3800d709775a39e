"""Many bodies, stepped from impact to impact: `World` and `WorldBatch`."""
