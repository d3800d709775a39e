"""The parser of all commands, and arguments that several take; this module is not a command."""

import argparse
import math
import re
import shutil
import textwrap
from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from itertools import groupby
from typing import Any, NoReturn

from ..experiment.errors import SettingsError
from ..experiment.numbers import parse_whole
from ..experiment.packaged import DEFAULT_AGENT, packaged_agents
from ..experiment.programs import arkanoid

# The settings that decide how a saved model plays.
PLAYED = (
    *("env_id", "env", "training.device", "training.torch_threads"),
    *("evaluation.seed", "evaluation.deterministic"),
)
# And those that decide how it is measured.
MEASURED = ("env_id", "env", "training.device", "training.torch_threads", "evaluation")
NAMED = "named"  # stands for all named levels
# What `--level` and LEVEL take, everywhere.
LEVELS = (
    "a level's name, a level file, seed:N for a generated one, or several: seeds:A-B, train, test, "
    "named"
)
LEVEL = "a level's name, a level file, or seed:N for a generated one"
# Lines are not longer, however wide the terminal is.
_WIDEST = 100
_HARD = "\xa0"  # a space at which no line ends


class Parser(argparse.ArgumentParser):
    """A parser that tells a mistake in a sentence, as `SettingsError`."""

    def error(self, message: str) -> NoReturn:
        """Raise `SettingsError` with argparse's message in our words."""
        what, _, rest = message.partition(": ")
        if what == "the following arguments are required":
            message = f"{rest} is missing"
        elif what == "unrecognized arguments":
            raise self.unknown(rest.split()[0])
        raise SettingsError(f"{message}; {self._see_help()}")

    def unknown(self, word: str) -> SettingsError:
        """Return the error for a word that this command does not take."""
        if not word.startswith("-"):
            return SettingsError(f"{word!r} is one argument too many; {self._see_help()}")
        name = word.partition("=")[0]
        near = close_to(name, self.option_names())
        hint = f"did you mean {near}?" if near else self._see_help()
        return SettingsError(f"unknown option {name}; {hint}")

    def option_names(self) -> list[str]:
        """Return the long names of all options."""
        return [name for name in self._option_string_actions if name.startswith("--")]

    def takes_value(self, option: str) -> bool:
        """Tell whether an option of `option_names` has a value."""
        return self._option_string_actions[option].nargs != 0

    def _see_help(self) -> str:
        return f"see {arkanoid(*self.prog.split()[1:], '--help')}"


class Help(argparse.RawDescriptionHelpFormatter):
    """Help that fits the terminal, with the columns side by side."""

    def __init__(self, prog: str) -> None:
        super().__init__(prog, max_help_position=24, width=help_width())

    def add_argument(self, action: argparse.Action) -> None:
        """Measure an argument; argparse forgets by how much the commands are indented."""
        super().add_argument(action)
        if action.nargs == argparse.PARSER:
            self._action_max_length += self._indent_increment

    def _format_usage(self, usage: Any, actions: Any, groups: Any, prefix: Any) -> str:
        """Fold a usage that is given as a text, but not inside brackets."""
        text = super()._format_usage(usage, actions, groups, prefix).rstrip()
        if "\n" not in text:
            whole_ = re.sub(r"\[[^][]*\]", lambda part: part[0].replace(" ", _HARD), text)
            text = textwrap.fill(
                whole_, self._width, subsequent_indent=" " * 8, break_on_hyphens=False
            ).replace(_HARD, " ")
        return f"{text}\n\n"

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        """Fold paragraphs; lines that begin with a space stay as they are."""
        parts = []
        for is_plain, lines in groupby(text.splitlines(), lambda line: line[:1].strip() != ""):
            joined = "\n".join(lines)
            parts.append(textwrap.fill(joined, width) if is_plain else joined)
        return "\n".join(parts)


def check_settings(
    overrides: Sequence[tuple[str, str]], taken: Sequence[str], but: Sequence[str] = ()
) -> None:
    """Raise `SettingsError` if one of the settings ``(key, text)`` would change nothing.

    Keys that are none at all are left to whoever reads the settings.

    Args:
        overrides: as typed.
        taken: what the command makes use of: keys, and tables of keys.
        but: keys in these tables that it does not.
    """
    from ..experiment.reading import describe_settings
    from ..experiment.settings import Experiment

    def is_taken(key: str) -> bool:
        return key not in but and (key in taken or key.partition(".")[0] in taken)

    known = describe_settings(Experiment)
    tables = {key.partition(".")[0] for key in known}
    for key, _ in overrides:
        if is_taken(key) or key.partition(".")[0] not in tables:
            continue
        name = key.rpartition(".")[2]
        meant = [one for one in known if is_taken(one) and one.rpartition(".")[2] == name]
        takes = [one if one in known and not known[one].is_free else f"{one}.KEY" for one in taken]
        hint = f"did you mean --{meant[0]}?" if meant else f"what does: {', '.join(takes)}"
        raise SettingsError(f"--{key} changes nothing here; {hint}")


def help_width() -> int:
    """Return how long the lines of a help may be."""
    return min(shutil.get_terminal_size().columns, _WIDEST) - 1


def output_width() -> int:
    """Return how long printed lines may be: as the terminal is wide, 80 in a file."""
    return shutil.get_terminal_size().columns


def close_to(word: str, known: Iterable[str]) -> str | None:
    """Return the known word that may be meant, or None."""
    return next(iter(get_close_matches(word, list(known), 1, cutoff=0.7)), None)


def whole(least: int | None = None) -> Callable[[str], int]:
    """Return a type of arguments: integers, also as 1e6, that are at least ``least``."""
    bound = "" if least is None else f", at least {least}"

    def read(text: str) -> int:
        value = parse_whole(text)
        if value is None or (least is not None and value < least):
            raise argparse.ArgumentTypeError(f"must be an integer{bound}, not {text!r}")
        return value

    return read


def number(least: float, most: float = math.inf) -> Callable[[str], float]:
    """Return a type of arguments: finite numbers from ``least`` to ``most``."""
    range_ = f"at least {least:g}" if most == math.inf else f"from {least:g} to {most:g}"

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not (least <= value <= most and math.isfinite(value)):
            raise argparse.ArgumentTypeError(f"must be a number, {range_}, not {text!r}")
        return value

    return read


def positive(text: str) -> float:
    """Read a finite number above 0."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"must be a number above 0, not {text!r}")
    return value


def check_difficulty(levels: Iterable[str]) -> None:
    """Raise `SettingsError` if none of some levels is generated: others have no difficulty."""
    from ...envs.levels.plan import seed_range

    if all(seed_range(level) is None for level in levels):
        raise SettingsError("--difficulty is of generated levels, as in seed:7")


def add_model(parser: argparse.ArgumentParser) -> None:
    """Add the argument that names a model."""
    parser.add_argument(
        "model",
        metavar="MODEL",
        nargs="?",
        help="the folder of a run, a model's .zip file, or the name of an agent in the package: "
        f"{', '.join(packaged_agents())}; default: {DEFAULT_AGENT}",
    )
    add_trust(parser)


def add_level(parser: argparse.ArgumentParser) -> None:
    """Add the option that names a level."""
    parser.add_argument("--level", help=f"{LEVELS}; default: as in the training")


def add_trust(parser: argparse.ArgumentParser) -> None:
    """Add the option that trusts a run's author."""
    parser.add_argument(
        "--trust",
        action="store_true",
        help="trust the author of the run: import the module that its env_id names, and let "
        "stable-baselines3 unpickle its model, with any network; both can run any command on this "
        "computer. Without --trust no code in a run is run",
    )
