"""What a run began with, if not with random weights: another model, or a data set's clone.

``run.json`` has it as ``lineage``, a table: ``kind`` ("model" or "data set"), ``name`` (path or
id), ``decisions`` (that the model was trained for, or that the data set has) and ``weights`` (their
hash); of a data set also ``episodes``, ``loss``, ``accuracy`` and ``data`` (the hash of its
content). The model itself is the run's ``start.zip``.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...envs.atomic import write_atomically
from ...envs.checks import counted
from ...envs.reading import read_limited
from .errors import SettingsError
from .files import cause
from .packaged import find_agent
from .runs import RunFolder

MODEL = "model"
DATASET = "data set"
LARGEST_MODEL = 2**32  # bytes of a file


def find_model(name: str) -> Path:
    """Return a model's file: that which is named, or the best or else the last one of a run.

    The run may be a packaged agent's, by its name.

    Raises `SettingsError` if there is none.
    """
    path = find_agent(name)
    run = RunFolder(path)
    candidates = (run.best, run.model) if path.is_dir() else (path,)
    for candidate in candidates:
        if candidate.is_file():
            return candidate
    raise SettingsError(
        f"{name}: no trained model there; give the folder of a run, or a model's .zip file"
    )


def earlier_decisions(path: Path) -> int:
    """Return how many decisions lie before the training that made a model, as its run knows."""
    lineage = RunFolder(path.parent).read_notes().get("lineage")
    return lineage["decisions"] if lineage and lineage["kind"] == MODEL else 0


def begin_like(folder: RunFolder, other: RunFolder) -> None:
    """Let the run in ``folder`` begin with the weights that another one began with.

    Raises `SettingsError` if the other one says that it began with a model which is gone.
    """
    lineage = other.read_notes().get("lineage")
    if not other.start.exists():
        if lineage:
            raise SettingsError(
                f"{other.start}: missing; it holds the weights that the training began with"
            )
        return
    try:
        write_atomically(folder.start, read_limited(other.start, LARGEST_MODEL))
        folder.add_notes(lineage=lineage)
    except OSError as error:
        raise SettingsError(f"{other.start}: cannot be copied: {cause(error)}") from None
    except ValueError as error:
        raise SettingsError(f"{other.start}: {error}") from None


def describe_lineage(lineage: Mapping[str, Any] | None) -> str | None:
    """Return a sentence about what a run began with, or None: random weights."""
    if not lineage:
        return None
    name, decisions, weights = lineage["name"], lineage["decisions"], lineage["weights"][:16]
    if lineage["kind"] == MODEL:
        return (
            f"It began with the weights of {name}, trained for {counted(decisions, 'decision')} "
            f"(SHA-256 of the weights: {weights}...)."
        )
    return (
        f"It began as a clone of the data set {name}, which has {counted(decisions, 'decision')} "
        f"(SHA-256 of the weights: {weights}...)."
    )
