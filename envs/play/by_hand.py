"""Playing by hand in a window, and watching recorded games."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..batch.batch import Batch
from ..batch.replays import Replay
from ..config import Config
from ..levels import CAMPAIGN
from .gallery import DIFFICULTY, parse_seed
from .scores import Scores, game_name
from .show import run_show, screen_height
from .sitting import Board, Sitting
from .sound import Speaker
from .viewer import REPLAY_KEYS, Viewer

TITLE = "Arkanoid"
REPLAY_TITLE = f"{TITLE} replay - {REPLAY_KEYS}"
# A human player decides in each tick, and no number of decisions ends the game.
BY_HAND: dict[str, Any] = {"actions": "box", "frame_skip": 1, "max_decisions": 10**9}


def hand_config(
    level: str | None = None, difficulty: float | None = None, **keywords: Any
) -> tuple[Config, dict[str, Any]]:
    """Return the configuration and the first reset options of games that are played by hand.

    Args:
        level: the name of a named level: the campaign from there on; the path of a level file or
            ``"seed:7"`` for a generated level: that level again and again; any other text that
            the keyword ``levels`` takes; None: the campaign from its beginning.
        difficulty: of generated levels; None: 0.5 for ``"seed:7"``, otherwise it rises from round
            to round.
        keywords: other keywords of the environment, see `Config`.

    Raises:
        TypeError, ValueError: a value is illegal. Whether the level exists is not checked.
    """
    seed = None if level is None else parse_seed(level)
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
    scores: Path | None = None,
) -> bool:
    """Open a window and let someone play until it is closed; return whether Ctrl-C ended it.

    Args:
        config: the configuration of the games, see `hand_config`.
        options: how the games begin, as for `reset`.
        seed: the seed of their random numbers.
        keep: is called with each game that was begun, when the game is over or the player leaves
            it; also after Ctrl-C.
        scores: the file of high scores; None: they are forgotten.

    Raises:
        DependencyNotInstalled: pygame-ce is missing.
        ValueError: there is no such level, or a value is illegal.
    """
    usual = Config.from_keywords(BY_HAND)
    board = Board(Scores(scores), lambda begun: game_name(config, usual, begun))
    sitting = Sitting(config, options, seed, keep, screen_height(), board, Speaker())
    # All kernels are compiled now, and not while somebody plays.
    _rehearse(config, options)
    sitting.picture()
    try:
        return run_show(sitting, TITLE)
    finally:
        sitting.close()


def view_replay(replay: Replay, speed: float = 1.0) -> bool:
    """Show a recorded game in a window; return whether Ctrl-C ended it.

    Args:
        replay: the game.
        speed: a factor on the speed at which it was played.

    Raises:
        DependencyNotInstalled: pygame-ce is missing.
        ReplayDivergedError: the game differs from the recording.
    """
    viewer = Viewer(replay, speed, screen_height())
    return run_show(viewer, REPLAY_TITLE)


def _rehearse(config: Config, options: dict[str, Any]) -> None:
    """Play a tick of a game that nobody sees."""
    batch = Batch(1, config)
    batch.seed(0, 0)
    batch.reset(np.ones(1, np.bool_), options)
    batch.step()
    batch.close()
