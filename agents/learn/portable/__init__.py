"""Trained networks as small files, for the kernel that computes them in browsers."""

from .file import portable_network

__all__ = ["portable_network"]
