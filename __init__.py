"""Arkanoid: an exact 2-D collision engine, a Gymnasium environment on it, and PPO agents."""

from .version import __version__

__all__ = ["__version__"]
