"""Independent seeds for everything that an experiment draws.

Gymnasium and stable-baselines3 give world ``i`` of the seed ``s`` the seed ``s + i``. So runs with
the seeds 0 and 1 would share 63 of 64 worlds, and results over several seeds would not be
independent. Here NumPy's `SeedSequence` spreads each seed, for each purpose differently.
"""

from enum import IntEnum

import numpy as np


class Purpose(IntEnum):
    """What seeds are for; equal seeds of two purposes have nothing in common."""

    TRAINING = 0  # the worlds that an agent trains in
    VALIDATION = 1  # the episodes that choose the best model
    EVALUATION = 2  # the episodes that are reported, and shown in films
    VALIDATION_POLICY = 3  # a policy's own draws during a validation
    EVALUATION_POLICY = 4
    TRIAL = 5  # the experiments' seeds in a search
    SAMPLER = 6  # the draws of a search
    BLIND = 7  # what a collapsed policy is compared with
    DATASET = 8  # games that are recorded to learn from
    LEVELS = 9  # the draws of a training that chooses its levels


def spread_seeds(seed: int, purpose: Purpose, count: int) -> list[int]:
    """Return independent seeds in [0, 2^64); more of them begin with the same ones."""
    sequence = np.random.SeedSequence(seed, spawn_key=(purpose,))
    return [int(each) for each in sequence.generate_state(count, np.uint64)]


def spread_seed(seed: int, purpose: Purpose, index: int = 0, bits: int = 64) -> int:
    """Return one seed in [0, 2^bits), the same as at ``index`` of `spread_seeds` for 64 bits."""
    return spread_seeds(seed, purpose, index + 1)[index] >> (64 - bits)
