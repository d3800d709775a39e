import numpy as np
import pytest
from arkanoid.agents.measure import intervals
from arkanoid.agents.measure.intervals import (
    bootstrap_interval,
    interquartile_mean,
    mean,
    stratified_interval,
)
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
    assert interval.estimate == mean
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


def test_one_sample_has_no_interval() -> None:
    """It was shown as ``± 0.00``, as if a second game could not end otherwise."""
    for interval in (bootstrap_interval([0.5]), stratified_interval([[0.0, 1.0]], mean)):
        assert interval.estimate == 0.5
        assert not interval.is_known
        assert str(interval) == "0.50"
        assert interval.as_json() == {"estimate": 0.5, "low": None, "high": None}


def test_the_same_samples_get_the_same_interval() -> None:
    samples = np.arange(20.0)
    assert bootstrap_interval(samples) == bootstrap_interval(samples)


@pytest.mark.parametrize("samples", [[], [[1.0, 2.0]], 3.0])
def test_without_a_list_of_samples_there_is_no_interval(samples: object) -> None:
    with pytest.raises(ValueError, match="non-empty list of numbers"):
        bootstrap_interval(samples)  # type: ignore[arg-type]


def test_it_is_shown_with_half_of_its_width() -> None:
    assert str(bootstrap_interval([1234.0, 1236.0])) == "1235 ± 1"
    assert str(bootstrap_interval([0.5, 0.5])) == "0.50 ± 0.00"


def test_the_interquartile_mean_is_scipys_trimmed_mean() -> None:
    random = np.random.default_rng(3)
    for size in (1, 2, 3, 4, 5, 8, 13, 100):
        samples = random.exponential(size=(7, size))
        expected = [stats.trim_mean(row, 0.25) for row in samples]
        np.testing.assert_allclose(interquartile_mean(samples), expected, rtol=1e-12)


def test_of_one_stratum_the_stratified_interval_is_the_plain_one() -> None:
    samples = np.random.default_rng(2).normal(size=40)
    assert stratified_interval(samples[:, None], mean, resamples=10_000) == bootstrap_interval(
        samples
    )


def test_strata_are_resampled_each_on_its_own() -> None:
    """Against the closed form: the mean of strata has the mean of their variances / (n strata).

    Levels differ by much more than episodes of one level, and an interval that mixed them would be
    far too wide. The tolerance is five standard errors of 2000 resamples' percentiles, each of
    which is 0.06 of the mean's standard error.
    """
    random = np.random.default_rng(8)
    samples = random.normal(size=(400, 5)) + np.array([0, 100, 200, 300, 400])
    interval = stratified_interval(samples, mean)
    error = np.sqrt(samples.var(axis=0).mean() / samples.size)
    assert interval.estimate == pytest.approx(samples.mean())
    assert abs(interval.low - (samples.mean() - 1.96 * error)) < 5 * 0.06 * error
    assert abs(interval.high - (samples.mean() + 1.96 * error)) < 5 * 0.06 * error


def test_the_stratified_interval_of_the_interquartile_mean() -> None:
    """Against a plain loop over resamples, with SciPy's trimmed mean and random numbers of its own.

    The tolerance is five standard errors of the difference of two percentiles of 2000 resamples.
    """
    random = np.random.default_rng(9)
    samples = random.exponential(size=(10, 6)) * np.arange(1, 7)
    drawn = []
    for _ in range(2000):
        columns = [random.choice(column, len(column)) for column in samples.T]
        drawn.append(stats.trim_mean(np.concatenate(columns), 0.25))
    low, high = np.quantile(drawn, [0.025, 0.975])
    interval = stratified_interval(samples, interquartile_mean)
    tolerance = 5 * 0.06 * np.sqrt(2) * np.std(drawn)
    assert interval.estimate == pytest.approx(stats.trim_mean(samples, 0.25, axis=None))
    assert abs(interval.low - low) < tolerance
    assert abs(interval.high - high) < tolerance


def test_many_samples_are_resampled_in_parts_with_the_same_result(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    samples = np.random.default_rng(1).normal(size=(30, 4))
    whole = stratified_interval(samples, interquartile_mean)
    monkeypatch.setattr(intervals, "_CHUNK", 120 * 7)
    assert stratified_interval(samples, interquartile_mean) == whole


@pytest.mark.parametrize("samples", [[], [1.0, 2.0], [[]]])
def test_without_strata_there_is_no_stratified_interval(samples: object) -> None:
    with pytest.raises(ValueError, match=r"numbers \[n, strata\]"):
        stratified_interval(samples, mean)  # type: ignore[arg-type]
