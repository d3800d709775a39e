"""`arkanoid play`: the game by hand, in a window; each game is kept as a replay."""

import argparse
import secrets
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import platformdirs

from ..experiment.schema import SettingsError

if TYPE_CHECKING:
    from ...envs.batch.replays import Replay

SUMMARY = "play by hand, in a window"

# The simplest game, as `ArkanoidLite-v0` has it.
_LITE = {"capsules": False, "enemies": False}

_EPILOG = """\
keys:
  left, right, A, D, or the mouse   move the paddle
  space, or the left button         fire: serve, release a caught ball, shoot, start, go on
  P   pause          N   begin a game with the next round
  R   restart        F   fill the screen
  Esc quit"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the command to ``parser``."""
    parser.add_argument(
        "--level",
        metavar="LEVEL",
        help="a named round, from which on the campaign is played; a level file, or seed:N, which "
        "is played again and again (see: arkanoid levels)",
    )
    parser.add_argument(
        "--difficulty",
        type=float,
        metavar="D",
        help="of generated levels, from 0 to 1 (default: 0.5 for seed:N, else rising)",
    )
    parser.add_argument(
        "--seed", type=int, metavar="N", help="of the random numbers (default: another each time)"
    )
    parser.add_argument("--lite", action="store_true", help="without capsules and enemies")
    parser.add_argument(
        "--speed", type=float, metavar="X", help="factor on the ball's speed (default: 1)"
    )
    parser.add_argument("--lives", type=int, metavar="N", help="balls to begin with (default: 3)")
    parser.add_argument(
        "--save",
        metavar="FILE",
        help="where the replay goes; more games of one sitting, and files that are there already, "
        f"get a number (default: a dated file in {_replay_folder()})",
    )
    parser.epilog = _EPILOG


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Play until the window is closed; return the exit status (130 after Ctrl-C)."""
    # With the game come the kernels, and Numba, which is slow to import.
    from ...envs.play.by_hand import hand_config, play_by_hand

    keywords: dict[str, Any] = {
        name: getattr(arguments, name)
        for name in ("speed", "lives")
        if getattr(arguments, name) is not None
    }
    seed = secrets.randbits(62) if arguments.seed is None else arguments.seed
    save = _Saver(arguments.save)
    try:
        config, options = hand_config(
            arguments.level, arguments.difficulty, **keywords | (_LITE if arguments.lite else {})
        )
        interrupted = play_by_hand(config, options, seed, save)
    except OSError as error:
        raise SettingsError(f"{error.filename}: {error.strerror}") from None
    except ValueError as error:
        raise SettingsError(str(error)) from None
    return 130 if interrupted else 0


class _Saver:
    """Saves replays, and says where; none is overwritten."""

    def __init__(self, path: str | None) -> None:
        self._path = None if path is None else Path(path)
        folder = _replay_folder() if self._path is None else self._path.parent
        # Now, and not after the game, it shows whether the folder can be made.
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
        print(f"score {result.score}, round {result.round}; see it again: arkanoid replay {path}")


def free_path(path: Path) -> Path:
    """Return a path without a file: the one given, or it with a number before its suffix."""
    number = 2
    free = path
    while free.exists():
        free = path.with_stem(f"{path.stem}-{number}")
        number += 1
    return free


def _replay_folder() -> Path:
    """Return the user's folder for games; one here, if the user has no home (as in containers)."""
    try:
        return Path(platformdirs.user_data_dir("arkanoid", False)).expanduser() / "replays"
    except RuntimeError:
        return Path("replays")
