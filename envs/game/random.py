"""Random numbers from a generator whose whole state is one word of the world's record.

Marsaglia's xorshift64 (Xorshift RNGs, J. Stat. Softw. 8(14), 2003): only shifts and exclusive ors,
so that it gives the same bits compiled and interpreted, and results depend on neither the batch's
size, nor threads, nor the point of a restore.
"""

import numpy as np

from ...physics.kernels import inner, kernel
from ..state import WorldRecord

_A = np.uint64(13)
_B = np.uint64(7)
_C = np.uint64(17)
_TO_53_BITS = np.uint64(11)
_MASK = (1 << 64) - 1


def seed_state(seed: int) -> int:
    """Return the generator's first state for a seed >= 0 (SplitMix64's mixing; never zero)."""
    z = (seed + 0x9E3779B97F4A7C15) & _MASK
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & _MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & _MASK
    return (z ^ (z >> 31)) or 1


@kernel
def uniform(world: WorldRecord) -> float:
    """Draw a float64 in [0, 1)."""
    state = world.random
    state ^= state << _A
    state ^= state >> _B
    state ^= state << _C
    world.random = state
    return float((state >> _TO_53_BITS) * (1.0 / 9007199254740992.0))


@inner
def uniform_between(world: WorldRecord, low: float, high: float) -> float:
    """Draw a float64 in [low, high)."""
    return low + (high - low) * uniform(world)


@inner
def random_sign(world: WorldRecord) -> float:
    """Draw -1.0 or 1.0."""
    return 1.0 if uniform(world) < 0.5 else -1.0
