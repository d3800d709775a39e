"""A policy at play, as pictures drawn without a display: clips and what a window shows."""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..experiment.settings import Experiment
from ..experiment.worlds import make_worlds
from ..measure.episodes import begin_episodes
from ..measure.policy import Policy
from ..measure.suites import Start
from .film import write_film

TICKS_PER_SECOND = 60


class Frame(NamedTuple):
    """A picture of a game, and how far it has come."""

    picture: NDArray[np.uint8]  # [height, width, 3]
    score: int
    lives: int
    round: int


def record_clip(
    experiment: Experiment,
    policy: Policy,
    path: Path,
    start: Start | None = None,
    seconds: float | None = None,
) -> None:
    """Write the first evaluation episode as a GIF, a picture a decision, or an MP4, one a tick.

    It ends with the episode, or after so many seconds of the game (``evaluation.clip_seconds`` if
    not given). Raises `SettingsError` if the file's name ends otherwise.
    """
    smooth = path.suffix == ".mp4" and can_be_smooth(experiment)
    rate = frame_rate(experiment, smooth)
    count = int((seconds or experiment.evaluation.clip_seconds) * rate)
    frames = islice(play_frames(experiment, policy, start, smooth), max(1, count))
    write_film(path, (frame.picture for frame in frames), rate)


def can_be_smooth(experiment: Experiment) -> bool:
    """Tell whether the game can be shown tick by tick without another course.

    Not where the policy sees a stack of pictures, or a draw decides whether an action repeats.
    """
    stacked = int(experiment.env.get("stack", 1)) > 1
    return not stacked and not experiment.env.get("sticky_action", 0)


def frame_rate(experiment: Experiment, smooth: bool) -> float:
    """Return how many pictures are a second of the game: one a tick, or one a decision."""
    return TICKS_PER_SECOND / (1 if smooth else int(experiment.env.get("frame_skip", 4)))


def play_frames(
    experiment: Experiment, policy: Policy, start: Start | None = None, smooth: bool = False
) -> Iterator[Frame]:
    """Yield pictures of the first evaluation episode: at its beginning and after each step.

    With ``smooth`` a step is a tick, and the policy still decides as often as it was trained to;
    the game's course is the same.
    """
    skip = int(experiment.env.get("frame_skip", 4)) if smooth else 1
    extra: dict[str, Any] = {}
    if smooth:
        decisions = int(experiment.env.get("max_decisions", 27_000))
        extra = {"frame_skip": 1, "max_decisions": decisions * skip}
    worlds = make_worlds(experiment, 1, render_mode="rgb_array", **extra)
    only = np.zeros(1, np.int64)
    try:
        observations, infos = begin_episodes(
            worlds, experiment.evaluation.seed, (start or Start("whole games"),), 1
        )
        yield _frame(worlds, infos)
        while True:
            actions = policy(observations, only)
            for _ in range(skip):
                observations, _, terminated, truncated, infos = worlds.step(actions)
                if terminated[0] or truncated[0]:
                    return
                yield _frame(worlds, infos)
    finally:
        worlds.close()


def _frame(worlds: Any, infos: dict[str, Any]) -> Frame:
    picture = np.array(worlds.render()[0], np.uint8)
    score, lives, number = (int(infos[key][0]) for key in ("score", "lives", "round"))
    return Frame(picture, score, lives, number)
