"""How sure a mean is: bootstrap intervals."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

RESAMPLES = 10_000
LEVEL = 0.95


class Interval(NamedTuple):
    """A mean and the ends of its interval, in the unit of the data."""

    mean: float
    low: float
    high: float

    def __str__(self) -> str:
        """Return ``mean ± half of the interval's width`` with three significant digits or more."""
        half = (self.high - self.low) / 2
        digits = 0 if abs(self.mean) >= 100 else 1 if abs(self.mean) >= 10 else 2
        return f"{self.mean:.{digits}f} ± {half:.{digits}f}"


def bootstrap_interval(samples: ArrayLike, seed: int = 0) -> Interval:
    """Return the mean of samples [n] with its 95 % percentile bootstrap interval.

    Percentiles of the means of 10 000 resamples with replacement (Efron and Tibshirani, An
    Introduction to the Bootstrap, 1993, chapter 13). Raises ValueError without samples.
    """
    values = np.asarray(samples, dtype=np.float64)
    if values.ndim != 1 or values.size == 0:
        raise ValueError(
            f"samples must be a non-empty list of numbers, not of shape {values.shape}"
        )
    chosen = np.random.default_rng(seed).integers(values.size, size=(RESAMPLES, values.size))
    tail = (1 - LEVEL) / 2
    low, high = np.quantile(values[chosen].mean(axis=1), [tail, 1 - tail])
    return Interval(float(values.mean()), float(low), float(high))
