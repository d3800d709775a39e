"""Arkanoid: an exact 2-D collision engine, a Gymnasium environment on it, and PPO agents.

``import arkanoid`` registers ``Arkanoid-v0`` with Gymnasium, and imports neither torch,
stable-baselines3, pygame nor matplotlib.
"""

from .version import __version__

__all__ = ["__version__"]

# A test runner may import this file again under its folder's name; only the package registers.
if __name__ == "arkanoid":
    from .agents.interrupts import end_at_interrupt, is_command

    if is_command():
        end_at_interrupt()
    from .envs.registration import register_environments

    register_environments()
