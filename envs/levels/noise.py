"""Random numbers by index: a hash of a seed and an index, without any state.

A level uses such numbers instead of a sequence, so that a number that is not needed (because the
user fixed the motif, say) changes none of the others. Products of 32-bit numbers fit into 64 bits:
nothing overflows, and compiled and interpreted code give the same bits.
"""

import numpy as np

from ...physics.kernels import kernel

_LOW = np.uint64(0xFFFFFFFF)
_HALF = np.uint64(32)
# Wellons' "lowbias32" (hash-prospector, 2018): shifts and factors that spread every bit of the
# input evenly over the output.
_SHIFT_A = np.uint64(16)
_SHIFT_B = np.uint64(15)
_FACTOR_A = np.uint64(0x7FEB352D)
_FACTOR_B = np.uint64(0x846CA68B)
_GOLDEN = np.uint64(0x9E3779B9)  # without it, the hash of 0 would be 0
_UNIT = 1.0 / 4294967296.0


@kernel
def _mix(word: np.uint64) -> np.uint64:
    """Map 32-bit numbers one to one to 32-bit numbers that look random."""
    word ^= word >> _SHIFT_A
    word = (word * _FACTOR_A) & _LOW
    word ^= word >> _SHIFT_B
    word = (word * _FACTOR_B) & _LOW
    return word ^ (word >> _SHIFT_A)


@kernel
def noise_key(seed: int) -> np.uint64:
    """Return the key of a seed in [0, 2^63): different seeds have different keys."""
    whole = np.uint64(seed)
    low = _mix(((whole & _LOW) + _GOLDEN) & _LOW)
    # Mixed twice: `noise` mixes the lower half once, and at index 0 the two would cancel.
    high = _mix((_mix(low ^ (whole >> _HALF)) + _GOLDEN) & _LOW)
    return (high << _HALF) | low


@kernel
def noise(key: np.uint64, index: int) -> float:
    """Return the float64 in [0, 1) of a key at an index >= 0."""
    word = _mix((np.uint64(index) + (key & _LOW)) & _LOW)
    return float(_mix(word ^ (key >> _HALF))) * _UNIT
