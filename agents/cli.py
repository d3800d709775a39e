"""The console script `arkanoid`.

Each subcommand is a module of `commands` with ``add_arguments(parser)`` and
``run(arguments, overrides)``, which returns the exit status. Only the module of the command that
runs is imported: playing by hand needs none of the packages for training.
"""

import argparse
import itertools
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any

from gymnasium.error import DependencyNotInstalled

from ..version import __version__
from .experiment.errors import SettingsError
from .experiment.files import cause, printable
from .interrupts import INTERRUPTED, noted_interrupts
from .output import OutputError, checked_output, harmless_notes

# Each subcommand, which is its module's name (with _ for -), and what it does.
COMMANDS = {
    "play": "play by hand, in a window",
    "replay": "show a recorded game, export it or check it",
    "levels": "list the named levels, or draw any level",
    "train": "train PPO on the game, then compare it with the baselines",
    "reproduce": "train a run again and compare its weights, bit for bit",
    "dataset": "write recorded games as a Minari data set",
    "tune": "search for hyper-parameters",
    "evaluate": "measure trained models against the baselines",
    "watch": "watch an agent play in a window",
    "film": "write a film of an agent at play",
    "report": "write one page about an agent: curves, tables, a film, settings",
    "warm-up": "compile all that the game needs, so that nothing waits for it later",
}
# These take no settings, ``--key value``: argparse reads all their options.
_WITHOUT_SETTINGS = {"play", "replay", "levels", "warm-up"}
# Options of the other commands that are no settings: without and with a value.
_FLAGS = {"--help", "--version", "--json", "--trust"}
_OPTIONS = {"--level", "--out", "--plots", "--resume", "--seconds", "--space", "--study"}
_OPTIONS |= {"--budget", "--config", "--decisions", "--games-seed", "--from", "--games"}
_OPTIONS |= {"--jobs", "--track", "--trials"}

# Packages that only some commands need -> the extra that installs them.
_EXTRAS = {
    "PIL": "train",
    "h5py": "minari",
    "minari": "minari",
    "mlflow": "mlflow",
    "wandb": "wandb",
    "filelock": "train",
    "imageio_ffmpeg": "train",
    "jinja2": "train",
    "markdown_it": "train",
    "matplotlib": "train",
    "optuna": "train",
    "pydantic": "train",
    "stable_baselines3": "train",
    "tensorboard": "train",
    "tomli_w": "train",
    "torch": "train",
    "tqdm": "train",
    "pygame": "play",
}


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit status.

    0: done; 1: an extra is missing, a replay plays another game than was recorded, or the reader
    of the output has ended; 2: the user's mistake, or the output cannot be written; 130: Ctrl-C.
    """
    with harmless_notes(sys.stderr), noted_interrupts() as interrupts:
        try:
            with checked_output(sys.stdout):
                return _try(list(sys.argv[1:] if argv is None else argv))
        except KeyboardInterrupt:
            return _fail(INTERRUPTED, 130)
        except OutputError as error:
            if error.closed:  # as in `arkanoid levels | head`
                return 1
            return _fail(f"the output cannot be written: {cause(error.reason)}", 2)
        except Exception:
            # A module that Ctrl-C interrupts while it is imported can raise anything.
            if interrupts:
                return _fail(INTERRUPTED, 130)
            raise


def _try(words: list[str]) -> int:
    """Run the command line; tell its mistakes in a sentence, and return the exit status."""
    overrides: list[tuple[str, str]] = []
    if not words or words[0] not in _WITHOUT_SETTINGS:
        words, overrides = split_overrides(words)
    try:
        return _run(words, overrides)
    except SettingsError as error:
        return _fail(str(error), 2)
    except DependencyNotInstalled as error:
        return _fail(str(error), 1)
    except MemoryError as error:
        return _fail(f"not enough memory: {error}".removesuffix(": "), 2)
    except OSError as error:  # of a file that no command looks after
        return _fail(f"{error.filename or 'error of the system'}: {cause(error)}", 2)
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package not in _EXTRAS:
            raise
        command = f'pip install -e ".[{_EXTRAS[package]}]"'
        return _fail(f"{package} is missing: run `{command}` in arkanoid's repository", 1)


def split_overrides(argv: Sequence[str]) -> tuple[list[str], list[tuple[str, str]]]:
    """Split a command line into argparse's words and the settings ``--key value``.

    ``--key=value`` means the same. A word that begins with ``--`` and is no option of a command is
    a setting; its value may begin with a minus. Exits with a message if the value is missing.
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


def _run(words: list[str], overrides: list[tuple[str, str]]) -> int:
    """Parse the words and run the command; return its exit status."""
    parser = argparse.ArgumentParser(prog="arkanoid", description="Arkanoid, and agents for it.")
    parser.add_argument("--version", action="version", version=__version__)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    chosen = next((word for word in words if not word.startswith("-")), None)
    module: Any = None
    for name, summary in COMMANDS.items():
        command = commands.add_parser(
            name,
            help=summary,
            description=summary,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        if name == chosen:
            module = import_module(f".commands.{name.replace('-', '_')}", __package__)
            module.add_arguments(command)
    arguments = parser.parse_args(words)
    status: int = module.run(arguments, overrides)
    return status


def _fail(message: str, status: int) -> int:
    # The message may quote a file of somebody else's.
    print(f"arkanoid: error: {printable(message)}", file=sys.stderr)
    return status
