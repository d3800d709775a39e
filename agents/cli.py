"""The console script `arkanoid`.

Each subcommand is a module of `commands` with ``add_arguments(parser)`` and
``run(arguments, overrides)``, which returns the exit status. Only the module of the command that
runs is imported: playing by hand needs none of the packages for training.
"""

import os
import sys
from argparse import Namespace
from collections.abc import Sequence
from importlib import import_module
from typing import Any

from gymnasium.error import DependencyNotInstalled

from ..version import __version__
from .commands.arguments import Help, Parser, close_to
from .experiment.errors import SettingsError
from .experiment.files import cause, printable
from .experiment.programs import ARKANOID, activation, command, start_of
from .interrupts import INTERRUPTED, noted_interrupts
from .output import OutputError, checked_output, harmless_notes

# Each subcommand, which is its module's name (with _ for -), and what it does.
COMMANDS = {
    "play": "play by hand, in a window",
    "replay": "show a recorded game, export it or check it",
    "web": "play and watch agents in a browser, or write a page that does it",
    "levels": "list the named levels, or draw any level",
    "train": "train PPO on the game, then compare it with the baselines",
    "reproduce": "train a run again and compare its weights, bit for bit",
    "dataset": "write recorded games as a Minari data set",
    "tune": "search for hyper-parameters",
    "evaluate": "measure trained models against the baselines",
    "watch": "watch an agent play, in a window or a browser",
    "film": "write a film of an agent at play",
    "report": "write one page about an agent: curves, tables, a film, settings",
    "warm-up": "compile all that the game needs, so that nothing waits for it later",
}
# These take no settings, ``--key value``.
_WITHOUT_SETTINGS = {"play", "replay", "web", "levels", "warm-up"}

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
    try:
        _check_working_folder()
        return _run(words)
    except SettingsError as error:
        return _fail(str(error), 2)
    except DependencyNotInstalled as error:
        return _fail(str(error).replace("`pip ", f"`{start_of('pip')} "), 1)
    except MemoryError as error:
        return _fail(f"not enough memory: {error}".removesuffix(": "), 2)
    except OSError as error:  # of a file that no command looks after
        return _fail(f"{error.filename or 'error of the system'}: {cause(error)}", 2)
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package not in _EXTRAS:
            raise
        install = f'{command("pip", "install", "-e")} ".[{_EXTRAS[package]}]"'
        return _fail(f"{package} is missing: run `{install}` in arkanoid's repository", 1)


def _check_working_folder() -> None:
    """Raise `SettingsError` if the working folder is gone: torch would crash while it loads."""
    try:
        os.getcwd()
    except OSError as error:
        raise SettingsError(
            f"the folder that you are in cannot be read ({cause(error)}): go to another one"
        ) from None


def _run(words: list[str]) -> int:
    """Parse the words and run the command; return its exit status."""
    parser = Parser(
        prog=ARKANOID,
        usage="%(prog)s COMMAND ...",
        description="Arkanoid, and agents for it.",
        formatter_class=Help,
        epilog=f"{ARKANOID} COMMAND --help says more about one.{_how_to_start()}",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=__version__)
    if words[:1] == ["help"]:
        words = [*words[1:2], "--help"]
    chosen = next((word for word in words if not word.startswith("-")), None)
    if chosen is None and words and words[0] not in ("-h", "--help", "--version"):
        raise parser.unknown(words[0])
    if chosen is not None and chosen not in COMMANDS:
        near = close_to(chosen, COMMANDS)
        hint = f"did you mean {near}?" if near else f"the commands are {', '.join(COMMANDS)}"
        raise SettingsError(f"no command {chosen!r}; {hint}")
    commands = parser.add_subparsers(
        dest="command", required=True, metavar="COMMAND", title="commands", parser_class=Parser
    )
    module: Any = None
    chosen_parser = parser
    overrides: list[tuple[str, str]] = []
    for name, summary in COMMANDS.items():
        subparser = commands.add_parser(
            name,
            prog=f"{ARKANOID} {name}",
            help=summary,
            description=summary,
            formatter_class=Help,
            allow_abbrev=False,
        )
        if name == chosen:
            module = import_module(f".commands.{name.replace('-', '_')}", __package__)
            module.add_arguments(subparser)
            chosen_parser = subparser
            subparser.epilog = f"{subparser.epilog or ''}{_how_to_start()}"
            if name not in _WITHOUT_SETTINGS:
                words, overrides = split_overrides(words, subparser)
            begin = words.index(name) + 1
            words = [*words[:begin], *options_first(words[begin:], subparser)]
    if not words:
        parser.print_help()
        return 0
    arguments, left = parser.parse_known_args(words)
    if left:
        raise chosen_parser.unknown(left[0])
    _refuse_empty(arguments)
    status: int = module.run(arguments, overrides)
    return status


def _refuse_empty(arguments: Namespace) -> None:
    """Raise `SettingsError` if a text is empty, as that of a shell's variable which is not set."""
    for name, value in vars(arguments).items():
        if value == "" or (isinstance(value, list) and "" in value):
            raise SettingsError(f"an empty text is given for {name}; give one, or leave it out")


def split_overrides(
    words: Sequence[str], parser: Parser
) -> tuple[list[str], list[tuple[str, str]]]:
    """Split a command line into the words of a command's parser and the settings ``--key value``.

    ``--key=value`` means the same. A word that begins with ``--`` and is no option of the command
    is a setting; its value may begin with a minus. Raises `SettingsError` if the value is missing,
    or an option is meant.
    """
    options = {"--version", *parser.option_names()}
    own: list[str] = []
    overrides: list[tuple[str, str]] = []
    rest = iter(words)
    for word in rest:
        if word == "--":
            own += [word, *rest]
            break
        name, equals, value = word.partition("=")
        if not word.startswith("--") or name in options:
            own.append(word)
            if name in parser.option_names() and parser.takes_value(name) and not equals:
                own += [text for text in [next(rest, None)] if text is not None]
            continue
        if _is_meant_for(name, parser):
            raise parser.unknown(name)
        if not equals:
            following = next(rest, None)
            if following is None:
                raise SettingsError(f"{word} needs a value")
            value = following
        overrides.append((name.removeprefix("--"), value))
    return own, overrides


def options_first(words: Sequence[str], parser: Parser) -> list[str]:
    """Return what follows a command's name with its options first and its arguments last.

    argparse takes arguments from one place only. What follows ``--`` stays where it is.
    """
    options: list[str] = []
    plain: list[str] = []
    rest = iter(words)
    for word in rest:
        if word == "--":
            plain += [word, *rest]
        elif not word.startswith("-"):
            plain.append(word)
        else:
            options.append(word)
            if word in parser.option_names() and parser.takes_value(word):
                options += [text for text in [next(rest, None)] if text is not None]
    return [*options, *plain]


def _is_meant_for(name: str, parser: Parser) -> bool:
    """Tell whether a word that is none of a parser's options is meant for one."""
    if "." in name or close_to(name, parser.option_names()) is None:
        return False
    try:
        from .experiment.reading import describe_settings
        from .experiment.settings import Experiment
    except ModuleNotFoundError:  # the command itself will say what is missing
        return False
    return name.removeprefix("--") not in describe_settings(Experiment)


def _how_to_start() -> str:
    """Return what a help says where the shell does not know the command by its name."""
    activate = activation()
    if activate is None:
        return ""
    start = start_of(ARKANOID)
    return (
        f"\n\nThis shell does not know the name {ARKANOID}. Type its path, or activate the "
        f"environment first:\n  {start}\n  {activate}"
    )


def _fail(message: str, status: int) -> int:
    # The message may quote a file of somebody else's.
    print(f"arkanoid: error: {printable(message)}", file=sys.stderr)
    return status
