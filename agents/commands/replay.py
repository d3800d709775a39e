"""`arkanoid replay FILE`: shows a recorded game, writes it as a film or picture, or checks it."""

import argparse
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from ...envs.atomic import write_atomically
from ...envs.checks import counted
from ..experiment.errors import SettingsError
from ..experiment.files import check_folder, printable
from ..experiment.programs import arkanoid
from ..show.film import RATES, write_film
from .arguments import number, whole
from .screen import require_screen

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...envs.batch.replays import Replay

_FASTEST = 1000.0  # and as much slower
_HEIGHT = 512

_EPILOG = """\
keys in the window: space or P pause, + faster, - slower, R from the start, F fill the screen,
Esc quit

  arkanoid replay game.replay --export game.gif --from 10 --to 25 --height 256
  arkanoid replay game.replay --export last.png        the last picture
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.add_argument("file", metavar="FILE", help="a replay, as `arkanoid play` saves it")
    parser.add_argument(
        "--speed",
        type=number(1 / _FASTEST, _FASTEST),
        metavar="X",
        help="factor on the speed (default: 1)",
    )
    parser.add_argument(
        "--export",
        metavar="OUT",
        help=f"write a film ({', '.join(RATES)}) or the last picture (.png); needs no display",
    )
    parser.add_argument(
        "--verify",
        action="store_true",
        help="only play it again and check that each bit is as recorded",
    )
    parser.add_argument(
        "--from",
        dest="start",
        type=number(0.0),
        metavar="S",
        help="begin the export at this second",
    )
    parser.add_argument(
        "--to", dest="stop", type=number(0.0), metavar="S", help="end it at this second"
    )
    parser.add_argument(
        "--height",
        type=whole(2),
        metavar="N",
        help=f"of exported pictures (default: {_HEIGHT})",
    )
    parser.epilog = _EPILOG


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Show, export or check; return the exit status (1: another game; 130 after Ctrl-C)."""
    _check_together(arguments)
    if arguments.export is not None:
        _check_export(Path(arguments.export))
    # The game imports Numba, which is slow.
    from ...envs.batch.playback import ReplayDivergedError
    from ...envs.batch.replays import Replay

    try:
        replay = Replay.load(arguments.file)
        if arguments.verify:
            return _verify(replay)
        if arguments.export is not None:
            return _export(replay, arguments)
        words = ("replay", Path(arguments.file), "--export game.gif")
        require_screen(f"a film needs none: {arkanoid(*words)}")
        from ...envs.play.by_hand import view_replay

        return 130 if view_replay(replay, arguments.speed or 1.0) else 0
    except OSError as error:
        raise SettingsError(f"{error.filename}: {error.strerror}") from None
    except (TypeError, ValueError) as error:
        raise SettingsError(str(error)) from None
    except ReplayDivergedError as error:
        print(f"arkanoid: error: {printable(f'{arguments.file}: {error}')}", file=sys.stderr)
        return 1


def _check_together(arguments: argparse.Namespace) -> None:
    """Raise `SettingsError` if an option would change nothing beside the others."""
    of_films = {"--from": arguments.start, "--to": arguments.stop, "--height": arguments.height}
    if arguments.verify:
        needless = of_films | {"--speed": arguments.speed, "--export": arguments.export}
        reason = "nothing while --verify plays the whole game"
    else:
        needless = {} if arguments.export is not None else of_films
        reason = "what --export writes, and nothing else"
    given = [name for name, value in needless.items() if value is not None]
    if given:
        raise SettingsError(f"{given[0]} changes {reason}")


def _verify(replay: "Replay") -> int:
    from ...envs.batch.playback import play_replay

    result = play_replay(replay)
    decisions = counted(result.decisions, "decision")
    print(
        f"the same game, bit for bit: {decisions}, score {result.score}, round {result.round}; "
        f"recorded with release {replay.version}"
    )
    return 0


def _check_export(path: Path) -> None:
    """Raise `SettingsError` unless a film or picture of this name can be written."""
    if path.suffix.lower() not in (*RATES, ".png"):
        raise SettingsError(f"{path}: exports are {', '.join(RATES)} or .png")
    check_folder(path)


def _export(replay: "Replay", arguments: argparse.Namespace) -> int:
    path = Path(arguments.export)
    suffix = path.suffix.lower()
    rate = replay.frames_per_second * (arguments.speed or 1.0)
    if suffix in RATES:
        stride = max(1, math.ceil(rate / RATES[suffix]))
        write_film(path, _pictures(replay, arguments, stride), rate / stride)
    else:
        from ...envs.draw.png import png_bytes

        *_, picture = _pictures(replay, arguments, 0)
        write_atomically(path, png_bytes(picture))
    print(path)
    return 0


def _pictures(
    replay: "Replay", arguments: argparse.Namespace, stride: int
) -> Iterator["NDArray[np.uint8]"]:
    """Yield every ``stride``-th picture of a part of a game, and its last one (stride 0: only it).

    Height and width are even numbers, as films need.
    """
    from ...envs.batch.playback import replay_states
    from ...envs.draw.picture import draw_world
    from ...envs.draw.view import FULL_HEIGHT, FULL_WIDTH

    height = arguments.height or _HEIGHT
    height += height % 2
    width = round(height * FULL_WIDTH / FULL_HEIGHT / 2) * 2
    rate = replay.frames_per_second
    last = replay.result.decisions
    # Enormous numbers of seconds have no rounded product.
    if arguments.stop is not None:
        last = round(min(last, arguments.stop * rate))
    start = arguments.start or 0.0
    first = round(min(last + 1, start * rate))
    if first > last:
        raise SettingsError(
            f"the part from second {start:g} on is empty; the game lasts "
            f"{replay.result.decisions / rate:.1f} s"
        )
    for index, batch in enumerate(replay_states(replay)):
        wanted = stride > 0 and index >= first and (index - first) % stride == 0
        if wanted or index == last:
            yield draw_world(batch.worlds, batch.rules, 0, height, width)
        # A film to the end plays all of the replay, which then compares the result.
        if index == last < replay.result.decisions:
            return
