"""`arkanoid play`: the game by hand, in a window; it saves each game as a replay."""

import argparse
import itertools
import secrets
import sys
import tempfile
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import gymnasium as gym
import platformdirs

from ..experiment.errors import SettingsError
from ..experiment.files import cause, level_mistake, printable, quoted
from ..experiment.programs import arkanoid
from .arguments import LEVELS, NAMED, check_difficulty, whole
from .screen import require_screen

if TYPE_CHECKING:
    from ...envs.batch.replays import Replay
    from ...envs.config import Config

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
    try:
        # A level that is wrong must not be part of the command that works without a screen.
        config, options = _game(level, arguments)
        film = arkanoid("film", "game.gif", *([] if level is None else ["--level", quoted(level)]))
        require_screen(f"a film of an agent in the package needs none: {film}")
        from ...envs.play.by_hand import play_by_hand

        seed = secrets.randbits(62) if arguments.seed is None else arguments.seed
        save = _Saver(arguments.save)
        interrupted = play_by_hand(config, options, seed, save, save.scores)
    except OSError as error:
        raise SettingsError(f"{error.filename}: {error.strerror}") from None
    except ValueError as error:
        raise SettingsError(level_mistake("", error)) from None
    return 130 if interrupted else 0


def _game(level: str | None, arguments: argparse.Namespace) -> "tuple[Config, dict[str, Any]]":
    """Return the configuration of the games and how they begin.

    Raises OSError or ValueError for a level that there is not, or a value that is illegal.
    """
    # The game imports Numba, which is slow.
    from ...envs.levels import CAMPAIGN
    from ...envs.levels.plan import plan_levels
    from ...envs.play.by_hand import hand_config

    keywords: dict[str, Any] = dict(gym.spec("ArkanoidLite-v0").kwargs) if arguments.lite else {}
    keywords.pop("actions", None)  # a person has the fire button, here too
    for name in ("speed", "lives"):
        if getattr(arguments, name) is not None:
            keywords[name] = getattr(arguments, name)
    # After the campaign come generated levels.
    in_campaign = level is None or level in CAMPAIGN
    if arguments.difficulty is not None and not in_campaign:
        check_difficulty([str(level)])
    config, options = hand_config(level, arguments.difficulty, **keywords)
    plan_levels(config)
    return config, options


class _Saver:
    """Saves replays and says where; it never overwrites a file.

    What cannot be saved does not end the game: a line says so.

    Args:
        path: of the first replay; None: dated files in the user's folder, if it can be written.

    Attributes:
        scores: the user's file of high scores, beside the folder for replays; None if they cannot
            be kept.
    """

    def __init__(self, path: str | None) -> None:
        self._path = None if path is None else Path(path)
        self._folder = _replay_folder()
        # A folder that cannot be made is an error before the game, not after it.
        if self._path is not None:
            try:
                self._path.parent.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                folder = self._path.parent
                raise SettingsError(f"{folder}: {error.strerror}; choose another --save") from None
        reason = _why_unwritable(self._folder)
        self._keeps = self._path is not None or reason is None
        self.scores = None if reason is not None else self._folder.with_name("scores.json")
        if reason is not None:
            lost = (
                "high scores are not kept"
                if self._keeps
                else "neither replays nor high scores are kept; --save FILE keeps replays"
            )
            _warn(f"{self._folder.parent}: {reason}: {lost}")

    def __call__(self, replay: "Replay") -> None:
        result = replay.result
        again = ""
        if self._keeps:
            path = free_path(
                self._path or self._folder / f"{datetime.now():%Y-%m-%d_%H-%M-%S}.replay"
            )
            try:
                replay.save(path)
                again = f"; watch it: {arkanoid('replay', path)}"
            except OSError as error:
                _warn(f"{path}: the game could not be saved: {cause(error)}")
        print(f"score {result.score}, round {result.round}{again}")


def _why_unwritable(folder: Path) -> str | None:
    """Return why nothing can be kept in a folder, which is made if it can be; None if it can."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for one in (folder, folder.parent):
            tempfile.TemporaryFile(dir=one).close()
    except OSError as error:
        return cause(error)
    return None


def _warn(text: str) -> None:
    print(f"arkanoid: warning: {printable(text)}", file=sys.stderr, flush=True)


def free_path(path: Path) -> Path:
    """Return the path, or, if there is a file, the path with a number before its suffix."""
    copies = itertools.count(2)
    free = path
    while free.exists():
        free = path.with_stem(f"{path.stem}-{next(copies)}")
    return free


def _replay_folder() -> Path:
    """Return the user's folder for replays; without a home, as in containers, one right here."""
    try:
        return Path(platformdirs.user_data_dir("arkanoid", False)).expanduser() / "replays"
    except RuntimeError:
        return Path("replays")
