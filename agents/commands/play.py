"""`arkanoid play`: the game by hand, in a window; it saves each game as a replay."""

import argparse
import itertools
import secrets
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import gymnasium as gym
import platformdirs

from ..experiment.errors import SettingsError
from ..experiment.files import level_mistake, quoted
from ..experiment.programs import arkanoid
from .arguments import LEVELS, NAMED, whole
from .screen import require_screen

if TYPE_CHECKING:
    from ...envs.batch.replays import Replay

_EPILOG = """\
keys:
  left, right, A, D, mouse   move the paddle
  space, left button         fire: serve, release a ball, shoot, start, go on
  P   pause          N   begin a game with the next round (asks first)
  R   restart        F   fill the screen
  H   what is what   M   sound on or off
  Esc quit"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.add_argument(
        "--level",
        metavar="LEVEL",
        help=f"{LEVELS}; a name is where the campaign begins, a file or seed:N is played again and "
        "again",
    )
    parser.add_argument(
        "--difficulty",
        type=float,
        metavar="D",
        help="of generated levels, from 0 to 1 (default: 0.5 for seed:N, otherwise rising)",
    )
    parser.add_argument(
        "--seed",
        type=whole(),
        metavar="N",
        help="of the random numbers (default: a new one each time)",
    )
    parser.add_argument("--lite", action="store_true", help="without capsules and enemies")
    parser.add_argument(
        "--speed", type=float, metavar="X", help="factor on the ball's speed (default: 1)"
    )
    parser.add_argument(
        "--lives", type=whole(), metavar="N", help="balls to begin with (default: 3)"
    )
    parser.add_argument(
        "--save",
        metavar="FILE",
        help="where the replay goes; a number is added to the name of each further game, and if "
        f"the file exists (default: a dated file in {_replay_folder()})",
    )
    parser.epilog = _EPILOG


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Play until the window is closed; return the exit status (130 after Ctrl-C)."""
    level = None if arguments.level == NAMED else arguments.level
    film = arkanoid("film", "game.gif", *([] if level is None else ["--level", quoted(level)]))
    require_screen(f"a film of the agent that comes with the package needs none: {film}")
    # The game imports Numba, which is slow.
    from ...envs.play.by_hand import hand_config, play_by_hand

    keywords: dict[str, Any] = dict(gym.spec("ArkanoidLite-v0").kwargs) if arguments.lite else {}
    keywords.pop("actions", None)  # a person has the fire button, here too
    for name in ("speed", "lives"):
        if getattr(arguments, name) is not None:
            keywords[name] = getattr(arguments, name)
    seed = secrets.randbits(62) if arguments.seed is None else arguments.seed
    save = _Saver(arguments.save)
    try:
        config, options = hand_config(level, arguments.difficulty, **keywords)
        interrupted = play_by_hand(config, options, seed, save, _score_file())
    except OSError as error:
        raise SettingsError(f"{error.filename}: {error.strerror}") from None
    except ValueError as error:
        raise SettingsError(level_mistake("", error)) from None
    return 130 if interrupted else 0


class _Saver:
    """Saves replays and says where; it never overwrites a file."""

    def __init__(self, path: str | None) -> None:
        self._path = None if path is None else Path(path)
        folder = _replay_folder() if self._path is None else self._path.parent
        # A folder that cannot be made is an error before the game, not after it.
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise SettingsError(f"{folder}: {error.strerror}; choose another --save") from None

    def __call__(self, replay: "Replay") -> None:
        path = free_path(
            self._path or _replay_folder() / f"{datetime.now():%Y-%m-%d_%H-%M-%S}.replay"
        )
        replay.save(path)
        result = replay.result
        again = arkanoid("replay", path)
        print(f"score {result.score}, round {result.round}; watch it: {again}")


def free_path(path: Path) -> Path:
    """Return the path, or, if there is a file, the path with a number before its suffix."""
    copies = itertools.count(2)
    free = path
    while free.exists():
        free = path.with_stem(f"{path.stem}-{next(copies)}")
    return free


def _score_file() -> Path:
    """Return the user's file of high scores, beside the folder for replays."""
    return _replay_folder().with_name("scores.json")


def _replay_folder() -> Path:
    """Return the user's folder for replays; without a home, as in containers, one right here."""
    try:
        return Path(platformdirs.user_data_dir("arkanoid", False)).expanduser() / "replays"
    except RuntimeError:
        return Path("replays")
