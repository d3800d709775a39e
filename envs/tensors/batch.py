"""A batch whose worlds live in tensors, and are stepped where these are."""

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor
from torch.utils.dlpack import from_dlpack

from ...physics.kernels.one_thread import OneThread
from ..actions import BOX, COMMANDS, as_float32, read_array
from ..batch.batch import Autoreset, Batch
from ..draw.canvas import Drawn
from ..observe.pixels import PixelObserver
from ..observe.planes import ANY_CELL, MAX_MARKS, GridObserver
from ..observe.shown import forget_shown, nothing_shown
from ..observe.vector import VectorObserver
from ..state import INFO_FIELDS
from .arrays import Arrays
from .entries import STEPS
from .running import Runs

# Threads of a block on a card. One that plays a world needs nearly all registers that a thread may
# have: larger blocks would leave a part of the card without work.
_FEW, _MANY = 32, 256
_WORD = 8  # bytes of a picture that a thread moves
R = TypeVar("R")


class TensorBatch:
    """The worlds of a `Batch` in the memory of a device, which steps them.

    The batch has the last word on all that happens seldom: how episodes begin, snapshots and
    pictures for people. `pull` gives it the worlds for that; `on_host` lets it change them.

    Args:
        host: the batch.
        device: where.

    Attributes:
        rewards: float64 [n], of the latest step; terminated, truncated: bool [n].
        infos, final_infos: int64 [fields, n], in the order of `INFO_FIELDS`; the latter of the
            episodes that ended, in same-step mode.
        observations, finals: by the kind of observation, see `parts`; the latter are the last ones
            of the episodes that ended.
        illegal: int32 [n], how many illegal actions each world was given; each stood still.
        alone: it refuses other calls while one is in progress.
    """

    def __init__(self, host: Batch, device: torch.device) -> None:
        self.host, self.device = host, device
        self.alone = OneThread("this environment")
        count = host.num_worlds
        self._record = np.zeros(1, Arrays)
        self._kept: list[Tensor] = []
        self._is_ahead = False
        self._is_whole = True
        self._worlds = self._put("worlds", host.worlds)
        self._outcomes = self._put("outcomes", host.outcomes)
        self._put("rules", host.rules)
        self._put("levels", host.levels)
        self._put("commands", host.commands)
        self._set(num_levels=len(host.levels), count=count, autoreset=int(host.autoreset))
        self._set(episodic_life=host.config.episodic_life)
        table = COMMANDS.get(host.config.actions)
        if table is not None:
            self._put("table", table)
            self._set(num_actions=len(table))
            self._actions = self._put("actions", np.zeros(count, np.int64))
        else:
            self._actions = self._put("actions", np.zeros((count, 2), np.float32))
        self.illegal = self._put("illegal", np.zeros(count, np.int32))
        self.rewards = self._put("rewards", np.zeros(count))
        self.terminated = self._put("terminated", np.zeros(count, np.bool_))
        self.truncated = self._put("truncated", np.zeros(count, np.bool_))
        self.infos = self._put("infos", np.zeros((len(INFO_FIELDS), count), np.int64))
        self.final_infos = self._put("final_infos", np.zeros((len(INFO_FIELDS), count), np.int64))
        self._put("moves", np.zeros(count, np.uint8))
        self.observations: dict[str, Tensor] = {}
        self.finals: dict[str, Tensor] = {}
        self._forget: list[Callable[[], None]] = []
        add: dict[str, Callable[[Any], None]] = {
            "vector": self._add_vector,
            "grid": self._add_grid,
            "rgb": self._add_pictures,
        }
        for kind, observer in self._observers().items():
            add[kind](observer)
        self._record["here"] = True
        self._on_device = self._tensor(self._record)
        runs = STEPS[host.config.observation]
        here = Runs([run.entry for run in runs], device)
        self._steps = [
            (here.of(run.entry, _FEW if run.items == "world" else _MANY), self._items(run.items))
            for run in runs
            if host.autoreset is Autoreset.SAME_STEP or not run.same_step
        ]

    def __reduce__(self) -> tuple[Any, ...]:
        # Addresses are of no use to a copy: it gets tensors of its own.
        self.pull()
        return _again, (self.host, self.device, self.illegal)

    def step(self, actions: Any) -> None:
        """Play one decision in each world: integers [n], or velocity and fire, [n, 2].

        Raises:
            TypeError, ValueError: they have another form. Which values are illegal is not looked
                at here, because that would wait for the device.
            RuntimeError: another call is in progress.
        """
        self.alone.run(self._step, self._read(actions))

    def _step(self, actions: Tensor) -> None:
        if not self._is_whole:
            self._mend()
        self._actions.copy_(actions)
        # Until all of it is done: Ctrl-C may come at any time.
        self._is_ahead, self._is_whole = True, False
        address = self._on_device.data_ptr()
        for run, items in self._steps:
            run(items, address)
        self._is_whole = True

    def _mend(self) -> None:
        """Begin the episodes that an interrupted call has ended and not begun again."""
        self._pull()
        self.host.end_interrupted_step()
        self._push()

    def on_host(self, function: Callable[..., R], *arguments: Any, **keywords: Any) -> R:
        """Call a function that changes the worlds in the host, and take them from there.

        Raises:
            RuntimeError: another call is in progress.
        """
        result: R = self.alone.run(self._on_host, function, *arguments, **keywords)
        return result

    def _on_host(self, function: Callable[..., R], *arguments: Any, **keywords: Any) -> R:
        self._pull()
        # Until all of it is done: Ctrl-C may come at any time.
        self._is_whole = False
        try:
            result: R = function(*arguments, **keywords)
        finally:
            self._push()
        self._is_whole = True
        return result

    def pull(self) -> None:
        """Give the worlds to the host, if they were stepped since it had them.

        Raises:
            RuntimeError: another call is in progress.
        """
        self.alone.run(self._pull)

    def _pull(self) -> None:
        if not self._is_ahead:
            return
        host = self.host
        shown = np.empty(host.observations.shape, host.observations.dtype)
        for kind, tensor in self.observations.items():
            into = shown if shown.dtype.names is None else shown[kind]
            into[...] = tensor.cpu().numpy()
        worlds, outcomes = (each.cpu().numpy() for each in (self._worlds, self._outcomes))
        host.adopt(worlds, outcomes, shown)
        self._is_ahead = False

    def _push(self) -> None:
        """Take the worlds of the host."""
        host = self.host
        _copy(self._worlds, host.worlds)
        _copy(self._outcomes, host.outcomes)
        for kind, tensor in self.observations.items():
            seen = host.observations
            seen = seen if seen.dtype.names is None else seen[kind]
            tensor.copy_(torch.from_numpy(np.ascontiguousarray(seen)))
        for forget in self._forget:
            forget()
        self._is_ahead = False

    def _items(self, what: str) -> int:
        """Return how many items a run has."""
        record = self._record[0]
        each = {
            "world": 1,
            "vector": record["vector_size"],
            "grid": record["grid_size"],
            "picture": record["channels"] * record["height"] * record["width"],
        }[what]
        if what == "picture" and each % _WORD == 0:
            each //= _WORD
        return self.host.num_worlds * int(each)

    def _read(self, actions: Any) -> Tensor:
        """Return actions as a tensor of the right form."""
        shape = tuple(self._actions.shape)
        discrete = len(shape) == 1
        what = f"{shape[0]} integers" if discrete else f"numbers of shape {shape}, in {BOX}"
        if not isinstance(actions, Tensor):
            actions = _read_others(actions, what)
        if isinstance(actions, Tensor):
            check_plain(actions, "actions")
            # Detached: the worlds take no part in the gradients of a network that chose velocities.
            found, kind = actions.detach(), _kind_of(actions)
        else:
            found, kind = actions, actions.dtype.kind
        if tuple(found.shape) != shape or kind not in ("iu" if discrete else "iuf"):
            raise ValueError(
                f"actions must be {what}; got {found.dtype} of shape {tuple(found.shape)}"
            )
        if isinstance(found, Tensor):
            return found
        return torch.from_numpy(found.astype(np.int64) if discrete else as_float32(found))

    def _observers(self) -> dict[str, Any]:
        """Return the host's observers by their kind."""
        kind = self.host.config.observation
        if kind == "dict":
            return dict(self.host.observer.parts)  # type: ignore[attr-defined]
        return {kind: self.host.observer}

    def _add_vector(self, observer: VectorObserver) -> None:
        shape = observer.observations.shape
        self._observe("vector", "vectors", np.zeros(shape, np.float32))
        self._set(vector_size=shape[1], plain_length=observer.plain_length)
        self._remember("vector_shown", nothing_shown(shape[0]), forget_shown)
        if observer.shows_landings:
            self._set(landings_start=observer.landings_start)

    def _add_grid(self, observer: GridObserver) -> None:
        shape = observer.observations.shape
        self._observe("grid", "grids", np.zeros(shape, np.float32))
        self._set(grid_size=int(np.prod(shape[1:])))
        self._remember("grid_shown", nothing_shown(shape[0]), forget_shown)

        def erase_all(marks: NDArray[np.int32]) -> None:
            marks[:, 0] = ANY_CELL

        self._remember("marks", np.zeros((shape[0], 1 + MAX_MARKS), np.int32), erase_all)

    def _add_pictures(self, observer: PixelObserver) -> None:
        sheets, count = observer.sheets, self.host.num_worlds
        height, width = sheets[0].background.shape
        places = (count, observer.stack * len(sheets), height, width)
        self._observe("rgb", "pictures", np.zeros(places, np.uint8), observer.channels_last)
        self._set(stack=observer.stack, channels=len(sheets), height=height, width=width)
        self._put("canvas", np.zeros((count, len(sheets), height, width), np.uint8))
        self._remember("drawn", np.zeros((count, len(sheets)), Drawn), lambda drawn: None)
        self._put("views", sheets[0].views)
        for channel, sheet in enumerate(sheets):
            arrays: tuple[Any, ...] = sheet.palette, sheet.background, sheet.looks
            for field, array in zip(("palettes", "backgrounds", "looks"), arrays, strict=True):
                self._record[field][0, channel] = self._tensor(array).data_ptr()
        looks = sheets[0].looks
        self._set(num_colours=len(sheets[0].palette), num_looks=looks.shape[0])
        self._set(look_rows=looks.shape[1], look_columns=looks.shape[2])

    def _observe(
        self, kind: str, field: str, array: NDArray[Any], channels_last: bool = False
    ) -> None:
        """Make the tensors of a kind of observation, and of the last ones of episodes."""
        for target, name in ((self.observations, field), (self.finals, f"final_{field}")):
            tensor = self._put(name, array)
            target[kind] = tensor.movedim(1, -1) if channels_last else tensor

    def _remember(
        self, field: str, memory: NDArray[Any], forget: Callable[[NDArray[Any]], None]
    ) -> None:
        """Make an observer's memory, which is forgotten when the host has changed the worlds."""
        forget(memory)
        tensor = self._put(field, memory)
        self._forget.append(lambda: _copy(tensor, memory))

    def _set(self, **numbers: int) -> None:
        for field, number in numbers.items():
            self._record[field] = number

    def _put(self, field: str, array: NDArray[Any]) -> Tensor:
        """Put an array into the device's memory, and its address into the record."""
        tensor = self._tensor(array)
        self._record[field] = tensor.data_ptr()
        return tensor

    def _tensor(self, array: NDArray[Any]) -> Tensor:
        """Return an array in the device's memory; of records, their bytes [n, size]."""
        tensor = torch.empty_like(_as_tensor(array), device=self.device)
        _copy(tensor, array)
        self._kept.append(tensor)
        return tensor


def _again(host: Batch, device: torch.device, illegal: Tensor) -> TensorBatch:
    """Return the batch of a host that was copied or unpickled."""
    batch = TensorBatch(host, device)
    batch.on_host(lambda: None)
    batch.illegal.copy_(illegal)
    return batch


def check_plain(tensor: Tensor, what: str) -> None:
    """Raise a TypeError if a tensor is no plain array of numbers."""
    if tensor.is_nested or tensor.layout is not torch.strided or tensor.is_meta:
        kind = "nested" if tensor.is_nested else "meta" if tensor.is_meta else tensor.layout
        raise TypeError(f"{what} must be a dense tensor with its numbers in memory; got {kind}")


def _read_others(actions: Any, what: str) -> Any:
    """Return actions that are no tensor as a tensor or an array; those of a card stay there."""
    if isinstance(actions, np.ndarray) or not hasattr(actions, "__dlpack__"):
        return read_array(actions, what)
    try:
        return from_dlpack(actions)
    except (BufferError, RuntimeError, TypeError, ValueError) as error:
        raise TypeError(f"{actions!r:.200} is not {what}, and no tensor: {error}") from error


def _kind_of(tensor: Tensor) -> str:
    """Return the kind of a tensor's numbers, as NumPy names it."""
    if tensor.is_complex():
        return "c"
    if tensor.dtype == torch.bool:
        return "b"
    return "f" if tensor.is_floating_point() else "i"


def _as_tensor(array: NDArray[Any]) -> Tensor:
    """Return an array as a tensor, of the same memory where torch takes it; of records, bytes."""
    array = np.ascontiguousarray(array)
    if array.dtype.names is not None:
        array = array.reshape(-1).view(np.uint8).reshape(array.size, -1)
    # Torch warns of arrays that may not be written.
    return torch.from_numpy(array if array.flags.writeable else array.copy())


def _copy(tensor: Tensor, array: NDArray[Any]) -> None:
    tensor.copy_(_as_tensor(array).view(tensor.shape))
