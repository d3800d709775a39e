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
_LOW = np.uint64(0xFFFFFFFF)
_HALF = np.uint64(32)
# Of SplitMix64.
_GAMMA = np.uint64(0x9E3779B97F4A7C15)
_FACTOR_A = np.uint64(0xBF58476D1CE4E5B9)
_FACTOR_B = np.uint64(0x94D049BB133111EB)
_SHIFT_A = np.uint64(30)
_SHIFT_B = np.uint64(27)
_SHIFT_C = np.uint64(31)


def seed_state(seed: int) -> int:
    """Return the generator's first state for a seed >= 0; seeds that are 2^64 apart share it."""
    return int(mix_seed(np.uint64(seed & _MASK)))


@kernel
def mix_seed(seed: np.uint64) -> np.uint64:
    """Return the generator's first state for a seed (SplitMix64's mixing; never zero)."""
    z = _sum(seed, _GAMMA)
    z = _product(z ^ (z >> _SHIFT_A), _FACTOR_A)
    z = _product(z ^ (z >> _SHIFT_B), _FACTOR_B)
    z ^= z >> _SHIFT_C
    return z if z != np.uint64(0) else np.uint64(1)


# By halves: NumPy warns where interpreted code overflows.
@kernel
def _sum(one: np.uint64, other: np.uint64) -> np.uint64:
    """Return the lower 64 bits of a sum."""
    low = (one & _LOW) + (other & _LOW)
    high = ((one >> _HALF) + (other >> _HALF) + (low >> _HALF)) & _LOW
    return (high << _HALF) | (low & _LOW)


@kernel
def _product(one: np.uint64, other: np.uint64) -> np.uint64:
    """Return the lower 64 bits of a product."""
    low = (one & _LOW) * (other & _LOW)
    across = ((one >> _HALF) * (other & _LOW)) & _LOW
    along = ((one & _LOW) * (other >> _HALF)) & _LOW
    high = ((low >> _HALF) + across + along) & _LOW
    return (high << _HALF) | (low & _LOW)


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
