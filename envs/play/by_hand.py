"""Playing by hand in a window, and looking at recorded games."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ..batch.batch import Batch
from ..batch.replays import Replay
from ..config import Config
from ..levels.files import CAMPAIGN
from ..rules import TICKS_PER_SECOND
from .gallery import DIFFICULTY, chosen_seed
from .show import run_show, screen_height
from .sitting import Sitting
from .viewer import Viewer

TITLE = "Arkanoid"
# A player by hand decides in each tick, and has all the time in the world.
BY_HAND: dict[str, Any] = {"actions": "box", "frame_skip": 1, "max_decisions": 10**9}


def hand_config(
    level: str | None = None, difficulty: float | None = None, **keywords: Any
) -> tuple[Config, dict[str, Any]]:
    """Return the configuration of games by hand, and the reset options that they begin with.

    Args:
        level: the name of a named round, from which on the campaign is played; the path of a file,
            which is played again and again; ``"seed:7"`` for a generated level, likewise; or what
            else the keyword ``levels`` takes as text. None is the campaign from its beginning.
        difficulty: of generated rounds; None: 0.5 for ``"seed:7"``, rising from round to round
            otherwise.
        keywords: of the environment, see `Config`.

    Raises:
        TypeError, ValueError: a value is illegal. That there is such a level is not checked.
    """
    seed = None if level is None else chosen_seed(level)
    options: dict[str, Any] = {}
    if seed is not None:
        keywords["levels"] = f"seeds:{seed}-{seed}"
        difficulty = DIFFICULTY if difficulty is None else difficulty
    elif level in CAMPAIGN:
        options["level"] = level
    elif level is not None:
        keywords["levels"] = level
    return Config.from_keywords(BY_HAND | keywords | {"difficulty": difficulty}), options


def play_by_hand(
    config: Config,
    options: dict[str, Any],
    seed: int,
    keep: Callable[[Replay], None],
) -> bool:
    """Open a window and let someone play, until it is closed; return whether it was interrupted.

    Args:
        config: of the games, see `hand_config`.
        options: how they begin, as for `reset`.
        seed: of their random numbers.
        keep: is given each game that was begun, when it is over or left; also after Ctrl-C.

    Raises:
        DependencyNotInstalled: pygame-ce is missing.
        ValueError: there is no such level, or a value is illegal.
    """
    sitting = Sitting(config, options, seed, keep, screen_height())
    # Whatever must be compiled is compiled now, and not while somebody waits for the ball.
    _rehearse(config, options)
    sitting.picture()
    try:
        return run_show(sitting, TITLE, TICKS_PER_SECOND)
    finally:
        sitting.close()


def view_replay(replay: Replay, speed: float = 1.0) -> bool:
    """Show a recorded game in a window; return whether it was interrupted.

    Args:
        replay: the game.
        speed: how many times as fast as it was played.

    Raises:
        DependencyNotInstalled: pygame-ce is missing.
        ReplayDivergedError: the game took another course when it was recorded.
    """
    viewer = Viewer(replay, speed, screen_height())
    return run_show(viewer, TITLE, viewer.frames_per_second)


def _rehearse(config: Config, options: dict[str, Any]) -> None:
    """Play a tick of a game that nobody sees."""
    batch = Batch(1, config)
    batch.seed(0, 0)
    batch.reset(np.ones(1, np.bool_), options)
    batch.step()
    batch.close()
