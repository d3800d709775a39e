"""How sure a mean is: bootstrap intervals.

Written here, because SciPy's bootstrap cannot resample within strata: the levels of a suite.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

RESAMPLES = 10_000
# For many levels at once, each of which is resampled.
STRATIFIED_RESAMPLES = 2_000
CONFIDENCE = 0.95
# Numbers that are resampled at once: they take at most some tens of megabytes.
_CHUNK = 2_000_000

# Takes an array [resamples, samples] and returns one number per resample.
Statistic = Callable[[NDArray[np.float64]], NDArray[np.float64]]


class Interval(NamedTuple):
    """A mean, or another statistic, and the ends of its interval, in the unit of the data.

    Of one sample there is no interval: then both ends are NaN.
    """

    estimate: float
    low: float
    high: float

    @property
    def is_known(self) -> bool:
        """Whether there is an interval."""
        return not math.isnan(self.low)

    def __str__(self) -> str:
        """Return ``estimate ± half of the width`` with three significant digits or more."""
        digits = 0 if abs(self.estimate) >= 100 else 1 if abs(self.estimate) >= 10 else 2
        half = f" ± {(self.high - self.low) / 2:.{digits}f}" if self.is_known else ""
        return f"{self.estimate:.{digits}f}{half}"

    def as_json(self) -> dict[str, float | None]:
        """Return the three numbers by their names, as JSON takes them: ends may be None."""
        return {
            name: None if math.isnan(value) else value for name, value in self._asdict().items()
        }


def bootstrap_interval(samples: ArrayLike, seed: int = 0) -> Interval:
    """Return the mean of samples [n] with its 95 % percentile bootstrap interval.

    Its ends are percentiles of the means of 10 000 resamples with replacement (Efron and
    Tibshirani, An Introduction to the Bootstrap, 1993, chapter 13). One sample has no
    interval. Raises ValueError without samples.
    """
    values = np.asarray(samples, dtype=np.float64)
    if values.ndim != 1 or values.size == 0:
        raise ValueError(
            f"samples must be a non-empty list of numbers, not of shape {values.shape}"
        )
    return stratified_interval(values[:, None], mean, seed, RESAMPLES)


def stratified_interval(
    samples: ArrayLike,
    statistic: Statistic,
    seed: int = 0,
    resamples: int = STRATIFIED_RESAMPLES,
) -> Interval:
    """Return a statistic of samples [n, strata] with its 95 % stratified bootstrap interval.

    Every resample draws n samples of each stratum (a level), with replacement, and takes the
    statistic of all n × strata numbers together (Agarwal et al., Deep Reinforcement Learning at the
    Edge of the Statistical Precipice, 2021). With n = 1 all resamples would be the same: there is
    no interval. Raises ValueError without samples.
    """
    values = np.asarray(samples, dtype=np.float64)
    if values.ndim != 2 or values.size == 0:
        raise ValueError(f"samples must be numbers [n, strata], not of shape {values.shape}")
    (point,) = statistic(values.reshape(1, -1))
    if len(values) == 1:
        return Interval(float(point), math.nan, math.nan)
    random = np.random.default_rng(seed)
    strata = np.arange(values.shape[1])
    at_once = max(1, _CHUNK // values.size)
    drawn: list[NDArray[Any]] = []
    for first in range(0, resamples, at_once):
        count = min(at_once, resamples - first)
        chosen = random.integers(len(values), size=(count, *values.shape))
        drawn.append(statistic(values[chosen, strata].reshape(count, -1)))
    tail = (1 - CONFIDENCE) / 2
    low, high = np.quantile(np.concatenate(drawn), [tail, 1 - tail])
    return Interval(float(point), float(low), float(high))


def mean(samples: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the means of samples [resamples, n]."""
    means: NDArray[np.float64] = samples.mean(axis=1)
    return means


def interquartile_mean(samples: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the means of the middle halves of samples [resamples, n].

    It leaves out a quarter of the samples, rounded down, at either end: outliers do not count, yet
    half of the samples does, unlike in the median.
    """
    cut = samples.shape[1] // 4
    means: NDArray[np.float64] = np.sort(samples, axis=1)[:, cut : samples.shape[1] - cut].mean(
        axis=1
    )
    return means
