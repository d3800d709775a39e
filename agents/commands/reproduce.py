"""`arkanoid reproduce RUN`: trains a run again and compares the weights, bit for bit."""

import argparse
from typing import Any

from ..experiment.errors import SettingsError
from ..experiment.files import printable
from .arguments import add_trust


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.usage = "%(prog)s RUN [--trust]"
    parser.add_argument("run", metavar="RUN", help="the folder of a run that has ended")
    add_trust(parser)


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Train again beside the run; return 0 if the weights are the same, else 1."""
    if overrides:
        raise SettingsError("a run is reproduced with its own settings: give no others")
    from ..experiment.lineage import begin_like, describe_lineage
    from ..experiment.runs import INTERRUPTED, RunFolder

    folder = RunFolder.of(arguments.run, arguments.trust)
    expected = folder.read_notes().get("weights")
    if expected is None:
        raise SettingsError(f"{folder.path}: the run has not ended; there is nothing to compare")
    path = folder.path.resolve()
    experiment = folder.experiment([("name", f"{path.name}-again"), ("output", str(path.parent))])
    from ..learn.training import train

    lineage = describe_lineage(folder.read_notes().get("lineage"))
    again = RunFolder.create(experiment)
    begin_like(again, folder)
    print(f"again: {again.path}")
    if lineage is not None:
        print(printable(lineage))
    # A trial of a search, for instance, may have been stopped before its end.
    notes = folder.read_notes()
    outcome, last = notes.get("outcome"), notes.get("timesteps", experiment.training.timesteps)

    def stop_there(step: int, means: dict[str, float]) -> str | None:
        return outcome if last <= step < experiment.training.timesteps else None

    if train(experiment, again, on_measure=stop_there) == INTERRUPTED:
        print(f"stopped before there was anything to compare; nothing needs {again.path}")
        return 130
    notes = again.read_notes()
    print(f"weights there  {printable(expected)}\nweights here   {notes['weights']}")
    if notes["weights"] == expected:
        print("the same, bit for bit")
        return 0
    print("they differ", *_differences(folder.read_notes(), notes), sep="\n")
    return 1


def _differences(there: dict[str, Any], here: dict[str, Any]) -> list[str]:
    """Return the differences between the origins of two runs, one line for each."""
    lines = []
    for table in ("versions", "hardware", "git"):
        one, other = there.get(table) or {}, here.get(table) or {}
        for key in sorted({*one, *other}):
            if one.get(key) != other.get(key):
                line = f"{table}.{key}: {one.get(key)!r} there, {other.get(key)!r} here"
                lines.append(printable(line))
    return lines or ["versions, commit and hardware are the same: please report this"]
