"""A policy at play, picture by picture, without a display: for films and for the window."""

import sys
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...envs.config import MOST_DECISIONS
from ...envs.rules import TICKS_PER_SECOND
from ..experiment.seeds import Purpose, spread_seed
from ..experiment.settings import Experiment
from ..experiment.worlds import make_worlds
from ..measure.episodes import begin_episodes
from ..measure.policy import Policy
from ..measure.suites import WHOLE_GAMES, EpisodeStart
from .film import write_film


class Frame(NamedTuple):
    """A picture of a game, and how far the game has come."""

    picture: NDArray[np.uint8]  # [height, width, 3]
    score: int
    lives: int
    round: int


def film_policy(
    experiment: Experiment,
    policy: Policy,
    path: Path,
    start: EpisodeStart = WHOLE_GAMES,
    seconds: float | None = None,
) -> None:
    """Write a film of the first evaluation episode.

    A GIF has one picture per decision, an MP4 one per tick where `can_be_smooth`.

    Args:
        experiment: says what is played.
        policy: who plays.
        path: of the film, ``.gif`` or ``.mp4``.
        start: how the episode begins.
        seconds: the film's length at most, in game time; None: ``evaluation.film_seconds``.

    Raises:
        SettingsError, OSError: as `write_film`.
    """
    smooth = path.suffix.lower() == ".mp4" and can_be_smooth(experiment)
    rate = frame_rate(experiment, smooth)
    count = int(min((seconds or experiment.evaluation.film_seconds) * rate, sys.maxsize // 2))
    frames = islice(play_frames(experiment, policy, start, smooth), max(1, count))
    write_film(path, (frame.picture for frame in frames), rate)


def can_be_smooth(experiment: Experiment) -> bool:
    """Tell whether the game stays the same when it is shown tick by tick.

    It does not if the policy sees a stack of pictures, or if chance repeats actions, or if it may
    last longer than a configuration allows.
    """
    config = experiment.config
    ticks = config.max_decisions * config.frame_skip
    return config.stack == 1 and not config.sticky_action and ticks <= MOST_DECISIONS


def frame_rate(experiment: Experiment, smooth: bool) -> float:
    """Return the pictures per second of the game: one per tick (``smooth``) or per decision."""
    return TICKS_PER_SECOND / (1 if smooth else experiment.config.frame_skip)


def play_frames(
    experiment: Experiment,
    policy: Policy,
    start: EpisodeStart = WHOLE_GAMES,
    smooth: bool = False,
    episode: int = 0,
) -> Iterator[Frame]:
    """Yield pictures of an evaluation episode: at its beginning and after each step.

    With ``smooth`` a step is a tick. The policy still decides as often as it was trained to, and
    the game is the same.
    """
    config = experiment.game
    skip = config.frame_skip if smooth else 1
    if smooth:
        config = replace(config, frame_skip=1, max_decisions=config.max_decisions * skip)
    worlds = make_worlds(experiment, 1, config, render_mode="rgb_array")
    only = np.zeros(1, np.int64)
    try:
        seed = spread_seed(experiment.evaluation.seed, Purpose.EVALUATION, episode)
        observations, infos = begin_episodes(worlds, [seed], (start,))
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
    score, lives, level_number = (int(infos[key][0]) for key in ("score", "lives", "round"))
    return Frame(picture, score, lives, level_number)
