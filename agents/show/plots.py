"""Plots of results: all policies, level by level, and the learning curves."""

import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...envs.atomic import write_atomically
from ..experiment.settings import Experiment
from ..learn.curves import SHOWN, measured
from ..measure.comparison import COLUMNS, Comparison, Results, level_interval, summarise
from ..measure.intervals import Interval, bootstrap_interval
from ..measure.suites import EpisodeStart, make_suites

# The measures that the bars show.
_BARS = ("cleared", "score", "hits", "steps")
_POINTS = 200
# Names come from files: a dollar in them is a dollar, and no formula.
_plain_texts = rc_context({"text.parse_math": False, "text.usetex": False})


def plot_comparison(experiment: Experiment, comparison: Comparison, folder: Path) -> list[Path]:
    """Draw a comparison into PNG files of a folder; return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    suites = make_suites(experiment)
    paths = []
    for name, results in comparison.items():
        figures = {name: plot_policies(name, results)}
        if len(suites[name].starts) > 1:
            figures[f"{name}-levels"] = plot_levels(name, suites[name].starts, results)
        for stem, figure in figures.items():
            paths.append(folder / f"{stem}.png")
            write_atomically(paths[-1], as_png(figure, dpi=120))
    return paths


@_plain_texts
def as_png(figure: Figure, dpi: int) -> bytes:
    """Return a figure as the content of a PNG file."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dpi)
    return buffer.getvalue()


@_plain_texts
def plot_policies(title: str, results: Mapping[str, Results]) -> Figure:
    """Draw the means of all policies, with their intervals."""
    figure = Figure(figsize=(3 * len(_BARS), 3.2), layout="constrained")
    names = list(results)
    for axes, measure in zip(figure.subplots(1, len(_BARS)), _BARS, strict=True):
        intervals = [summarise(results[name][measure])["mean"] for name in names]
        axes.barh(names, [interval.estimate for interval in intervals], xerr=_errors(intervals))
        axes.invert_yaxis()
        axes.set_xlabel(COLUMNS[measure])
        axes.set_xlim(left=0)
        axes.locator_params(axis="x", nbins=4)  # labels of more ticks would touch each other
        if measure != _BARS[0]:
            axes.set_yticks([])
    figure.suptitle(title)
    return figure


@_plain_texts
def plot_levels(
    title: str, starts: Sequence[EpisodeStart], results: Mapping[str, Results]
) -> Figure:
    """Draw the cleared rate of all policies on each level, with their intervals."""
    figure = Figure(figsize=(8, 1.2 + 0.28 * len(starts)), layout="constrained")
    axes = figure.subplots()
    places = np.arange(len(starts))
    marks = []
    for index, result in enumerate(results.values()):
        shift = 0.5 * (index / max(1, len(results) - 1) - 0.5)
        intervals = [level_interval(result["cleared"], level) for level in places.tolist()]
        bars = axes.errorbar(
            [interval.estimate for interval in intervals],
            places + shift,
            xerr=_errors(intervals),
            fmt="o",
            markersize=4,
        )
        marks.append(bars)
    axes.set_yticks(places, [start.name for start in starts])
    axes.invert_yaxis()
    axes.set_xlabel("cleared rate")
    axes.set_xlim(-0.05, 1.05)
    axes.grid(axis="x", alpha=0.3)
    # A label that begins with an underscore would be left out.
    axes.legend(marks, list(results), loc="center left", bbox_to_anchor=(1, 0.5))
    axes.set_title(title)
    return figure


@_plain_texts
def plot_curves(curves: Sequence[Sequence[Mapping[str, Any]]]) -> Figure:
    """Draw the learning curves of an agent: the mean of its runs, with its interval."""
    shown = {
        key: title
        for key, title in SHOWN.items()
        if all(len(measured(curve, key)) for curve in curves)
    }
    rows = max(1, -(-len(shown) // 3))
    figure = Figure(figsize=(12, 3 * rows), layout="constrained")
    panels = figure.subplots(rows, 3, squeeze=False).ravel()
    for axes, (key, title) in zip(panels, shown.items(), strict=False):
        steps, means, lows, highs = mean_curve(curves, key)
        axes.plot(steps, means)
        axes.fill_between(steps, lows, highs, alpha=0.25)
        axes.set_title(title, fontsize=10)
        axes.set_xlabel("decisions")
        axes.grid(alpha=0.3)
    for axes in panels[len(shown) :]:
        axes.set_axis_off()
    return figure


def mean_curve(curves: Sequence[Sequence[Mapping[str, Any]]], key: str) -> NDArray[np.float64]:
    """Return decisions, the runs' means, and both ends of their 95 % intervals, [4, points].

    All curves are read at the same decisions, as far as the shortest one goes, with straight lines
    between measurements. Each must have a finite one.
    """
    series = [measured(curve, key) for curve in curves]
    first, last = max(one[0, 0] for one in series), min(one[-1, 0] for one in series)
    steps = np.linspace(first, max(first, last), _POINTS)
    values = np.stack([np.interp(steps, one[:, 0], one[:, 1]) for one in series])
    intervals = np.array([bootstrap_interval(values[:, at]) for at in range(_POINTS)])
    lines: NDArray[np.float64] = np.concatenate([steps[None], intervals.T])
    return lines


def _errors(intervals: Sequence[Interval]) -> NDArray[np.float64]:
    """Return the distances from the estimates to the intervals' ends, [2, n], at least zero.

    Where there is no interval they are zero.
    """
    distances = [
        [interval.estimate - interval.low for interval in intervals],
        [interval.high - interval.estimate for interval in intervals],
    ]
    errors: NDArray[np.float64] = np.maximum(0.0, np.nan_to_num(np.array(distances)))
    return errors
