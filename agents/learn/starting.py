"""What a training begins with: random weights, those of another model, or cloned ones."""

import io
import json
import zipfile
from dataclasses import asdict
from pathlib import Path

import torch
from stable_baselines3 import PPO

from ...envs.atomic import write_atomically
from ...envs.reading import read_limited
from ..experiment.errors import SettingsError
from ..experiment.files import cause
from ..experiment.lineage import DATASET, LARGEST_MODEL, MODEL, earlier_decisions
from ..experiment.provenance import weights_hash
from ..experiment.runs import RunFolder
from ..experiment.settings import Experiment
from .cloning import clone, read_demonstrations
from .model import read_weights, save_model
from .tensors import read_entry

# Stable-baselines3's own data of a model: some tens of kilobytes of JSON.
_DATA = "data"
_LARGEST_DATA = 2**24
_MOST_DECISIONS = 10**15
_LONGEST_NAME = 1000  # letters


def check_source(source: Path, experiment: Experiment) -> None:
    """Raise `SettingsError` unless the experiment can begin with the weights in a model's file."""
    read_weights(source, experiment)
    earlier_decisions(source)


def inherit(folder: RunFolder, source: Path, experiment: Experiment) -> None:
    """Let a new run begin with a model: copy it into the folder, and note where it comes from.

    Raises `SettingsError` if the experiment cannot begin with it.
    """
    try:
        write_atomically(folder.start, read_limited(source, LARGEST_MODEL))
    except OSError as error:
        raise SettingsError(f"{source}: cannot be copied: {cause(error)}") from None
    except ValueError as error:
        raise SettingsError(f"{source}: {error}") from None
    weights = weights_hash(read_weights(folder.start, experiment))
    trained = earlier_decisions(source) + _trained_decisions(folder.start)
    folder.add_notes(
        lineage={
            "kind": MODEL,
            "name": str(source)[-_LONGEST_NAME:],
            "decisions": trained,
            "weights": weights,
        }
    )


def begin(model: PPO, experiment: Experiment, folder: RunFolder) -> None:
    """Give a new model the weights that its run begins with.

    They are those of the folder's ``start.zip``; without one, and with a data set to imitate, they
    are cloned and ``start.zip`` is written. Neither draws a random number that the training would
    draw. Raises `SettingsError` if the file or the data set does not fit.
    """
    with torch.random.fork_rng(devices=[]):
        _begin(model, experiment, folder)


def _begin(model: PPO, experiment: Experiment, folder: RunFolder) -> None:
    if folder.start.is_file():
        weights = read_weights(folder.start, experiment)
        lineage = folder.read_notes().get("lineage")
        if lineage and lineage["weights"] != weights_hash(weights):
            raise SettingsError(f"{folder.start}: its weights are not those that run.json tells of")
        model.policy.load_state_dict(weights)
    elif experiment.imitation.dataset:
        demonstrations = read_demonstrations(experiment, model)
        result = clone(model, demonstrations, experiment)
        save_model(model, folder.start, experiment)
        folder.add_notes(
            lineage={
                "kind": DATASET,
                "name": experiment.imitation.dataset[-_LONGEST_NAME:],
                "episodes": len(demonstrations.lengths),
                "decisions": len(demonstrations.actions),
                **asdict(result),
                "data": demonstrations.digest(),
                "weights": weights_hash(model.policy.state_dict()),
            }
        )


def _trained_decisions(path: Path) -> int:
    """Return how many decisions a model was trained for, as stable-baselines3 wrote it; else 0."""
    try:
        with zipfile.ZipFile(io.BytesIO(path.read_bytes())) as archive:
            count = json.loads(read_entry(archive, _DATA, _LARGEST_DATA))["num_timesteps"]
    except (ArithmeticError, KeyError, OSError, RecursionError, TypeError, ValueError):
        return 0
    except zipfile.BadZipFile:
        return 0
    return count if type(count) is int and 0 <= count <= _MOST_DECISIONS else 0
