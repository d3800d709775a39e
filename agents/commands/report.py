"""`arkanoid report RUN...`: one page about an agent, from the runs of several seeds."""

import argparse
from pathlib import Path

from ..experiment.runs import ModelFile
from ..experiment.schema import SettingsError
from .evaluate import group_by_experiment

SUMMARY = "write one page about an agent: curves, tables, a clip, settings"
DEFAULT_OUT = "report.html"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the command to ``parser``."""
    parser.usage = "%(prog)s RUN... [--out FILE.html|FILE.md] [--key value ...]"
    parser.add_argument(
        "runs", metavar="RUN", nargs="+", help="runs of one experiment with different seeds"
    )
    parser.add_argument(
        "--out",
        default=DEFAULT_OUT,
        help=f"an .html page with everything in it, or .md with its pictures in a folder beside "
        f"it; default: {DEFAULT_OUT}",
    )
    parser.epilog = "--key value changes how the models are measured, as for `evaluate`."


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Measure and write; return the exit status."""
    out = Path(arguments.out)
    if out.suffix not in (".html", ".md"):
        raise SettingsError(f"{out}: a report's name must end in .html or .md")
    models = [ModelFile.find(name) for name in arguments.runs]
    if len(group_by_experiment(models, overrides)) > 1:
        raise SettingsError(
            "a report is about one experiment: the runs differ in more than their seeds "
            "(`arkanoid evaluate` compares different ones)"
        )
    from ..show.card import describe_agent
    from ..show.page import as_html, as_markdown

    parts = describe_agent(models, overrides)
    try:
        if out.suffix == ".html":
            out.write_text(as_html(parts), encoding="utf-8")
        else:
            out.write_text(as_markdown(parts, out), encoding="utf-8")
    except OSError as error:
        raise SettingsError(f"{out}: cannot be written: {error}") from None
    print(out)
    return 0
