"""PPO with loops for many worlds at once."""

from .fast_ppo import FastPPO

__all__ = ["FastPPO"]
