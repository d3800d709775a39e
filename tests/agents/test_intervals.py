import numpy as np
import pytest
from arkanoid.agents.intervals import bootstrap_interval
from scipy import stats


@pytest.mark.parametrize(("ones", "count"), [(25, 50), (9, 100), (26, 30), (6, 20)])
def test_of_zeros_and_ones_it_is_the_binomial_distributions(ones: int, count: int) -> None:
    """The mean of a resample is binomial, so the percentiles are known in closed form.

    The counts are such that both percentiles lie more than four standard errors of 10 000 resamples
    within a step of the distribution: then they are exactly the distribution's.
    """
    samples = np.zeros(count)
    samples[:ones] = 1
    interval = bootstrap_interval(samples)
    mean = ones / count
    assert interval.mean == mean
    expected = stats.binom.ppf([0.025, 0.975], count, mean) / count
    np.testing.assert_allclose([interval.low, interval.high], expected, rtol=1e-12)


def test_it_is_scipys_percentile_bootstrap() -> None:
    """Both draw 10 000 resamples, each with an error of its own in the percentiles.

    A percentile p of B resamples has the standard error sqrt(p (1 - p) / B) / density, here 0.027
    of the mean's standard error; six times that, for two of them, is 0.23.
    """
    samples = np.random.default_rng(5).exponential(3.0, 80)
    theirs = stats.bootstrap(
        (samples,), np.mean, n_resamples=10_000, method="percentile", rng=np.random.default_rng(1)
    ).confidence_interval
    ours = bootstrap_interval(samples)
    tolerance = 0.23 * samples.std() / np.sqrt(len(samples))
    assert abs(ours.low - theirs.low) < tolerance
    assert abs(ours.high - theirs.high) < tolerance


def test_equal_samples_leave_no_doubt() -> None:
    assert bootstrap_interval([3.0] * 10) == (3.0, 3.0, 3.0)
    assert bootstrap_interval([3.0]) == (3.0, 3.0, 3.0)


def test_the_same_samples_get_the_same_interval() -> None:
    samples = np.arange(20.0)
    assert bootstrap_interval(samples) == bootstrap_interval(samples)


@pytest.mark.parametrize("samples", [[], [[1.0, 2.0]], 3.0])
def test_without_a_list_of_samples_there_is_no_interval(samples: object) -> None:
    with pytest.raises(ValueError, match="non-empty list of numbers"):
        bootstrap_interval(samples)  # type: ignore[arg-type]


def test_it_is_shown_with_half_of_its_width() -> None:
    assert str(bootstrap_interval([1234.0, 1236.0])) == "1235 ± 1"
    assert str(bootstrap_interval([0.5])) == "0.50 ± 0.00"
