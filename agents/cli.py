"""The console script `arkanoid`: one subcommand a module.

A command's module has ``SUMMARY``, ``add_arguments(parser)`` and ``run(arguments, overrides)``,
which returns the exit status. It imports what is slow or optional inside `run`.
"""

import argparse
import io
import itertools
import sys
from collections.abc import Sequence
from types import ModuleType

from gymnasium.error import DependencyNotInstalled

from .. import __version__
from .commands import (
    evaluate,
    levels,
    play,
    record,
    replay,
    report,
    reproduce,
    train,
    tune,
    watch,
)
from .experiment.schema import SettingsError

COMMANDS: dict[str, ModuleType] = {
    "play": play,
    "replay": replay,
    "levels": levels,
    "train": train,
    "reproduce": reproduce,
    "tune": tune,
    "evaluate": evaluate,
    "watch": watch,
    "record": record,
    "report": report,
}
# These take no settings, ``--key value``: all their options are argparse's.
_WITHOUT_SETTINGS = {"play", "replay", "levels"}

# Packages that only some commands need -> the extra that installs them.
_EXTRAS = {
    "PIL": "train",
    "imageio": "train",
    "imageio_ffmpeg": "train",
    "matplotlib": "train",
    "optuna": "train",
    "stable_baselines3": "train",
    "tensorboard": "train",
    "torch": "train",
    "tqdm": "train",
    "pygame": "play",
}


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit status.

    0: done; 1: an extra is missing, or a replay is not what was played; 2: the user's mistake;
    130: Ctrl-C.
    """
    if isinstance(sys.stdout, io.TextIOWrapper):
        # A letter that the terminal or file does not know is no reason to lose what was measured.
        sys.stdout.reconfigure(errors="replace")
    words = list(sys.argv[1:] if argv is None else argv)
    overrides: list[tuple[str, str]] = []
    if not words or words[0] not in _WITHOUT_SETTINGS:
        words, overrides = split_overrides(words)
    arguments = _parser().parse_args(words)
    try:
        status: int = COMMANDS[arguments.command].run(arguments, overrides)
    except SettingsError as error:
        return _fail(str(error), 2)
    except DependencyNotInstalled as error:
        return _fail(str(error), 1)
    except KeyboardInterrupt:
        return _fail("interrupted", 130)
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package not in _EXTRAS:
            raise
        return _fail(f'{package} is missing: pip install "arkanoid[{_EXTRAS[package]}]"', 1)
    return status


def split_overrides(argv: Sequence[str]) -> tuple[list[str], list[tuple[str, str]]]:
    """Split a command line into argparse's words and the settings ``--key value``.

    ``--key=value`` is the same. What begins with ``--`` and is no flag is a setting; its value may
    begin with a minus. Exits with a message if the value is missing.
    """
    words: list[str] = []
    overrides: list[tuple[str, str]] = []
    rest = iter(argv)
    for word in rest:
        key, equals, value = word.removeprefix("--").partition("=")
        if not word.startswith("--") or word in _FLAGS:
            words.append(word)
        elif f"--{key}" in _OPTIONS:
            words += [word] if equals else [word, *itertools.islice(rest, 1)]
        elif equals:
            overrides.append((key, value))
        else:
            text = next(rest, None)
            if text is None:
                sys.exit(_fail(f"{word} needs a value", 2))
            overrides.append((key, text))
    return words, overrides


# What is the commands' own, and no setting: without and with a value.
_FLAGS = {"--help", "--version", "--json"}
_OPTIONS = {"--level", "--out", "--plots", "--resume", "--seconds", "--space", "--study"}
_OPTIONS |= {"--trials"}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="arkanoid", description="Arkanoid, and agents for it.")
    parser.add_argument("--version", action="version", version=__version__)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, module in COMMANDS.items():
        command = commands.add_parser(
            name,
            help=module.SUMMARY,
            description=module.SUMMARY,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        module.add_arguments(command)
    return parser


def _fail(message: str, status: int) -> int:
    print(f"arkanoid: error: {message}", file=sys.stderr)
    return status
