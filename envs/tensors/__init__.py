"""Worlds whose state and results are tensors of torch, on a graphics card or on this processor."""
