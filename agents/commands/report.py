"""`arkanoid report RUN...`: one page about an agent, from runs with several seeds."""

import argparse
from pathlib import Path

from ..experiment.errors import SettingsError
from ..experiment.files import cause, check_folder
from ..experiment.programs import arkanoid
from .arguments import MEASURED, add_trust, check_settings
from .evaluate import group_by_experiment

DEFAULT_OUT = "report.html"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = "%(prog)s RUN... [--out FILE.html|FILE.md] [--trust] [--key value ...]"
    parser.add_argument(
        "runs", metavar="RUN", nargs="+", help="runs of one experiment with different seeds"
    )
    parser.add_argument(
        "--out",
        default=DEFAULT_OUT,
        help=f"an .html page with everything in it, or an .md page with its pictures in a folder "
        f"beside it; default: {DEFAULT_OUT}",
    )
    add_trust(parser)
    parser.epilog = "--key value changes how the models are measured, as for `evaluate`."


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Measure and write; return the exit status."""
    from ..experiment.runs import ModelFile

    out = Path(arguments.out)
    if out.suffix.lower() not in (".html", ".md"):
        raise SettingsError(f"{out}: a report's name must end in .html or .md")
    check_folder(out)
    check_settings(overrides, ("name", *MEASURED))
    models = [ModelFile.find(name, arguments.trust) for name in arguments.runs]
    if len(group_by_experiment(models, overrides)) > 1:
        raise SettingsError(
            "a report is about one experiment: the runs differ in more than their seeds "
            f"(`{arkanoid('evaluate')}` compares different ones)"
        )
    from ..show.page import write_page
    from ..show.report import describe_agent, show_alive

    facts, pictures = describe_agent(models, overrides)
    alive = show_alive(models[0], overrides) if out.suffix.lower() == ".html" else ""
    try:
        write_page(out, facts, pictures, alive)
    except OSError as error:
        raise SettingsError(f"{out}: cannot be written: {cause(error)}") from None
    print(out)
    return 0
