"""Recorded games as Minari data sets: written, and read from whoever made them.

Minari is imported on demand. A data set is known by its id, such as ``arkanoid/planner-v0``, and
lies in Minari's folder (``MINARI_DATASETS_PATH``), or is a folder that holds ``metadata.json``.
"""

import json
import re
import shutil
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from gymnasium.spaces import Discrete
from numpy.typing import NDArray

from ...envs.reading import read_limited
from .errors import SettingsError
from .files import cause
from .programs import arkanoid, command

_ID = re.compile(r"(?:[\w-]+/)*[\w-]+-v\d+")
_METADATA = "metadata.json"
_LARGEST_METADATA = 2**26  # bytes: the bounds of each pixel are in it
# How many episodes are in memory while a data set is written.
_CHUNK = 8


@dataclass(frozen=True)
class Episode:
    """A recorded game of n decisions.

    Attributes:
        observations: [n + 1, ...], the last one after the last decision.
        actions: [n, ...].
        rewards: float64 [n].
        terminated: whether the game was lost with its last decision; if not, it was truncated.
        seed: of the game, if it began with one.
    """

    observations: NDArray[Any]
    actions: NDArray[Any]
    rewards: NDArray[np.float64]
    terminated: bool
    seed: int | None = None


@dataclass(frozen=True)
class Written:
    """A data set that was written: its folder, and what is in it."""

    folder: str
    episodes: int
    decisions: int
    mean_return: float


def check_new(name: str) -> None:
    """Raise `SettingsError` unless a new data set can get this id."""
    if not _ID.fullmatch(name):
        raise SettingsError(
            f"{name!r} is no id of a data set: it is NAMESPACE/NAME-vNUMBER, as arkanoid/mine-v0"
        )
    if _place(name).exists():
        raise SettingsError(
            f"{name}: there is such a data set; take another name or version, or remove it: "
            f"{command('minari', 'delete', name)}"
        )


def write_dataset(
    name: str, episodes: Iterator[Episode], env: Any, player: str, description: str
) -> Written:
    """Write a new data set, all of it or nothing.

    Args:
        name: its id.
        episodes: at least one; they are written as they come.
        env: the single environment that a reader of the data set recovers.
        player: who plays.
        description: what it is.

    Raises:
        SettingsError: there are no episodes, or the files cannot be written.
    """
    minari = _minari()
    dataset: Any = None
    returns: list[float] = []
    try:
        while chunk := list(islice(episodes, _CHUNK)):
            buffers = [_buffer(episode) for episode in chunk]
            returns += [float(episode.rewards.sum()) for episode in chunk]
            if dataset is None:
                with warnings.catch_warnings():
                    # It warns of each fact about the author that is left out.
                    warnings.simplefilter("ignore", UserWarning)
                    dataset = minari.create_dataset_from_buffers(
                        name,
                        buffers,
                        env=env,
                        algorithm_name=player,
                        description=description,
                        jpeg_encoding=False,
                    )
            else:
                dataset.update_dataset_from_buffer(buffers)
    except BaseException as error:
        if dataset is not None:
            shutil.rmtree(Path(dataset.spec.data_path).parent, ignore_errors=True)
        if isinstance(error, OSError):
            raise SettingsError(f"{name}: cannot be written: {cause(error)}") from None
        raise
    if dataset is None:
        raise SettingsError(f"{name}: there are no games to write")
    folder = str(dataset.spec.data_path)
    return Written(folder, len(returns), dataset.total_steps, float(np.mean(returns)))


def _buffer(episode: Episode) -> Any:
    count = len(episode.actions)
    ends = np.zeros(count, np.bool_)
    ends[-1] = True
    return import_module("minari.data_collector").EpisodeBuffer(
        seed=episode.seed,
        observations=episode.observations,
        actions=episode.actions,
        rewards=episode.rewards,
        terminations=ends & episode.terminated,
        truncations=ends & (not episode.terminated),
    )


def open_dataset(name: str, observations: Any, actions: Any) -> Any:
    """Return Minari's data set of an id or a folder, whose files are not read yet.

    ``observations`` and ``actions`` are the spaces that it must have. Raises `SettingsError` if it
    is missing or damaged, or has other spaces.
    """
    folder = _find(name)
    try:
        metadata = json.loads(read_limited(folder / _METADATA, _LARGEST_METADATA))
        # Minari would make the environment that the file names, which can run any code.
        if not {"observation_space", "action_space"} <= metadata.keys():
            raise ValueError("it does not say what its spaces are")
        dataset = _minari().MinariDataset(str(folder))
        found = (dataset.observation_space, dataset.action_space)
    except Exception as error:  # a damaged file can raise anything
        raise _unreadable(name, error) from None
    wanted = (observations, actions)
    for what, theirs, ours in zip(("observations", "actions"), found, wanted, strict=True):
        if _space(theirs) != _space(ours):
            raise SettingsError(
                f"{name}: its {what} are {_space(theirs)}, those of the experiment {_space(ours)}: "
                f"write the data set again with the experiment's [env]"
            )
    return dataset


def read_dataset(name: str, observations: Any, actions: Any) -> list[Episode]:
    """Return the episodes of a data set; no code in it is run.

    Arguments and errors are those of `open_dataset`.
    """
    dataset = open_dataset(name, observations, actions)
    try:
        return [_read(episode, observations, actions) for episode in dataset.iterate_episodes()]
    except MemoryError:
        raise
    except Exception as error:  # a damaged file can raise anything
        raise _unreadable(name, error) from None


def _find(name: str) -> Path:
    """Return the folder of a data set's files."""
    folders = [Path(name), Path(name, "data")]
    if _ID.fullmatch(name):
        folders.append(_place(name) / "data")
    for folder in folders:
        if (folder / _METADATA).is_file():
            return folder
    raise SettingsError(
        f"'imitation.dataset' = {name!r}: no such data set here; "
        f"`{command('minari', 'list local')}` lists them, `{arkanoid('dataset')}` writes one"
    )


def _place(name: str) -> Path:
    """Return the folder that Minari keeps a data set in."""
    _minari()
    return Path(import_module("minari.storage.datasets_root_dir").get_dataset_path(name))


def _read(data: Any, observations: Any, actions: Any) -> Episode:
    """Return an episode that Minari read; raise ValueError if it cannot be one of these spaces."""
    count = len(data.rewards)
    seen, done = np.asarray(data.observations), np.asarray(data.actions)
    if seen.shape != (count + 1, *observations.shape) or done.shape != (count, *actions.shape):
        raise ValueError(f"episode {data.id} has arrays of other lengths")
    if seen.dtype != observations.dtype or not np.isfinite(seen).all():
        raise ValueError(f"episode {data.id} has observations that are none")
    if not count or not all(actions.contains(action) for action in done):
        raise ValueError(f"episode {data.id} has actions that are none")
    rewards = np.asarray(data.rewards, np.float64)
    if rewards.shape != (count,) or not np.isfinite(rewards).all():
        raise ValueError(f"episode {data.id} has rewards that are none")
    return Episode(seen, done, rewards, bool(np.asarray(data.terminations)[-1]))


def _space(space: Any) -> str:
    """Return what an array of the space is, in words."""
    if isinstance(space, Discrete):
        return f"one of {space.n}"
    return f"{space.dtype} {list(space.shape)}"


def _unreadable(name: str, error: Exception) -> SettingsError:
    return SettingsError(f"{name}: the data set cannot be read: {error}")


def _minari() -> Any:
    """Return Minari. Raises ModuleNotFoundError, which the command line explains."""
    import_module("h5py")  # without it Minari names an extra of its own
    return import_module("minari")
