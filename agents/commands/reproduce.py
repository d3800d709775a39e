"""`arkanoid reproduce RUN`: train again, and compare the weights bit for bit."""

import argparse
from dataclasses import replace
from typing import Any

from ..experiment.runs import RunFolder
from ..experiment.schema import SettingsError

SUMMARY = "train a run again and compare its weights, bit for bit"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Describe the command to ``parser``."""
    parser.usage = "%(prog)s RUN"
    parser.add_argument("run", metavar="RUN", help="the folder of a run that has ended")


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Train again beside the run; return 0 if the weights are the same, else 1."""
    if overrides:
        raise SettingsError("a run is reproduced with its own settings: give no others")
    folder = RunFolder.of(arguments.run)
    expected = folder.about().get("weights")
    if expected is None:
        raise SettingsError(f"{folder.path}: the run has not ended: there is nothing to compare")
    experiment = replace(
        folder.experiment(),
        name=f"{folder.path.resolve().name}-again",
        output=str(folder.path.resolve().parent),
    )
    from ..learn.training import INTERRUPTED, train

    again = RunFolder.create(experiment)
    print(f"again: {again.path}")
    if train(experiment, again) == INTERRUPTED:
        return 130
    about = again.about()
    print(f"weights there  {expected}\nweights here   {about['weights']}")
    if about["weights"] == expected:
        print("the same, bit for bit")
        return 0
    print("they differ", *_differences(folder.about(), about), sep="\n")
    return 1


def _differences(there: dict[str, Any], here: dict[str, Any]) -> list[str]:
    """Return in what the two runs' origins differ, a line each."""
    lines = []
    for table in ("versions", "hardware", "git"):
        one, other = there.get(table) or {}, here.get(table) or {}
        for key in sorted({*one, *other}):
            if one.get(key) != other.get(key):
                lines.append(f"{table}.{key}: {one.get(key)!r} there, {other.get(key)!r} here")
    return lines or ["versions, commit and hardware are the same: please report this"]
