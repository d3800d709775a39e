"""`ArkanoidTensorVectorEnv`: many games whose observations and results are tensors of torch."""

from typing import Any

import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

try:
    import torch
    from torch import Tensor
except ImportError as error:
    raise ImportError(
        "device=... gives tensors of torch, which is missing: "
        'pip install "arkanoid[gpu]" brings it; without device=... the results are NumPy arrays'
    ) from error

from ..physics.kernels.portable.cuda import cuda_core
from .batch.batch import Autoreset
from .state import INFO_FIELDS, Worlds
from .tensors.batch import TensorBatch, check_plain
from .vector_env import ArkanoidVectorEnv


class ArkanoidTensorVectorEnv(ArkanoidVectorEnv):
    """`ArkanoidVectorEnv` with its worlds on a graphics card, or on this processor, as tensors.

    Each game is the same, bit for bit. Observations, rewards, ends and infos are tensors on the
    device, and so may actions be; a step does not wait for the device. What differs:

    - An illegal action would have to be waited for. So it stands still, and `illegal_actions`
      counts it.
    - A world whose episode is over, in mode ``"Disabled"``, stays as it is until its reset, with a
      reward of 0.
    - In mode ``"SameStep"``, ``final_obs`` is one tensor, of which ``_final_obs`` says which rows
      are meant; they are in each step's infos, whether an episode has ended or not.
    - Resets by `reset`, snapshots and frames go through this processor, and take their time.
    - `record` is not there: replays are made by the other class.
    - `threads` changes nothing: a card decides itself, and ``device="cpu"``, which is there for
      tests and slow, has one thread.

    It is experimental.

    Args:
        device: ``"cuda"``, ``"cuda:1"``, ... or ``"cpu"``.
        num_envs: the number of worlds.
        copy: whether `step` returns fresh tensors. With False it returns the same ones each time:
            do not write into them.
        **keywords: as for `ArkanoidVectorEnv`.

    Raises:
        ImportError: a package is missing.
        RuntimeError: there is no such card, or it or its driver is too old.
        TypeError, ValueError: a keyword is unknown or its value is illegal.
        MemoryError: there is no room for so many worlds.
    """

    def __init__(self, device: str | torch.device, num_envs: int = 1, **keywords: Any) -> None:
        self.device = read_device(device)
        super().__init__(num_envs, **keywords)
        try:
            # Also where somebody makes it inside of inference mode, and steps outside of it.
            with torch.inference_mode(False):
                self._tensors = TensorBatch(self._batch, self.device)
        except (torch.OutOfMemoryError, MemoryError) as error:
            raise MemoryError(
                f"num_envs={num_envs} does not fit into the memory of {self.device}: take fewer, "
                f"or smaller observations ({error})"
            ) from error
        self._was_reset = np.zeros(num_envs, np.bool_)
        self._owners = torch.ones(num_envs, dtype=torch.bool, device=self.device)

    def __getstate__(self) -> dict[str, Any]:
        self._tensors.pull()
        return self.__dict__.copy()

    @property
    def illegal_actions(self) -> Tensor:
        """How many illegal actions each world was given, int32 [n], as a copy."""
        return self._tensors.illegal.clone()

    def reset(
        self, *, seed: Any = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begin an episode in every world, or in those of a mask, as `ArkanoidVectorEnv.reset`.

        The mask may be a tensor.
        """
        mask = self._everywhere
        if isinstance(options, dict) and "reset_mask" in options:
            mask = _read_mask(options["reset_mask"])
            options = {**options, "reset_mask": mask}
        _, infos = self._tensors.on_host(super().reset, seed=seed, options=options)
        self._was_reset |= mask
        return self._seen(), self._as_tensors(infos)

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """Play one decision in every world.

        Args:
            actions: integers [n], or velocity and fire, [n, 2]: a tensor, or what torch makes one
                of.

        Returns:
            Observations [n, ...]; rewards, float64 [n]; terminated and truncated, bool [n]; infos.

        Raises:
            TypeError, ValueError: the actions have another form.
            gymnasium.error.ResetNeeded: a world was never reset.
            RuntimeError: another call is in progress.
        """
        if not self._was_reset.all():
            never = np.flatnonzero(~self._was_reset)[:8].tolist()
            raise ResetNeeded(f"call reset() before the first step(): worlds {never} had none")
        tensors = self._tensors
        tensors.step(actions)
        terminated, truncated = self._own(tensors.terminated), self._own(tensors.truncated)
        infos: dict[str, Any] = {}
        if self._mode is Autoreset.SAME_STEP:
            infos = self._final_parts(terminated | truncated)
        infos |= self._table(tensors.infos, self._own(self._owners))
        return self._seen(), self._own(tensors.rewards), terminated, truncated, infos

    def observe(self) -> Any:
        """Return the latest observations, as `step` does."""
        return self._seen()

    def set_start(self, world: int, options: dict[str, Any]) -> None:
        """Set how a world's next games begin, while its present one goes on."""
        self._tensors.on_host(super().set_start, world, options)

    def restore(self, snapshot: bytes) -> tuple[Any, dict[str, Any]]:
        """Go on from a snapshot, of this class or of `ArkanoidVectorEnv`."""
        _, infos = self._tensors.on_host(super().restore, snapshot)
        self._was_reset[:] = True
        return self._seen(), self._as_tensors(infos)

    def spread(self, snapshot: bytes, seed: int | None = None) -> tuple[Any, dict[str, Any]]:
        """Bring all worlds into the same state."""
        _, infos = self._tensors.on_host(super().spread, snapshot, seed)
        self._was_reset[:] = True
        return self._seen(), self._as_tensors(infos)

    def snapshot(self, world: int | None = None) -> bytes:
        """Return the whole state of all worlds, or of one, as `ArkanoidVectorEnv` does."""
        self._tensors.pull()
        return super().snapshot(world)

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """Return a frame of each world, uint8 [height, width, 3] in this processor's memory."""
        self._tensors.pull()
        return super().render()

    def action_masks(self) -> Any:
        """Return which actions do something now, a tensor, bool [n, actions]."""
        self._tensors.pull()
        return torch.from_numpy(super().action_masks()).to(self.device)

    @property
    def state(self) -> Worlds:
        """The state of each game, NumPy records [n]: a read-only view of this processor's copy."""
        self._tensors.pull()
        return super().state

    def record(self, world: int = 0) -> Any:
        """Refuse: the device tells nobody of its steps."""
        raise NotImplementedError(
            "games on a device can't be recorded: make the environment without device=..., and "
            "restore a snapshot there"
        )

    def _own(self, tensor: Tensor) -> Tensor:
        return tensor.clone() if self.copy else tensor

    def _seen(self) -> Any:
        return self._parts(self._tensors.observations)

    def _parts(self, tensors: dict[str, Tensor]) -> Any:
        """Return observations as Gymnasium has them: a tensor, or a dictionary of them."""
        owned = {kind: self._own(tensor) for kind, tensor in tensors.items()}
        return owned if self.config.observation == "dict" else next(iter(owned.values()))

    def _final_parts(self, done: Tensor) -> dict[str, Any]:
        tensors = self._tensors
        return {
            "final_obs": self._parts(tensors.finals),
            "_final_obs": done,
            "final_info": self._table(tensors.final_infos * done, done),
            "_final_info": done,
        }

    def _table(self, table: Tensor, owners: Tensor) -> dict[str, Any]:
        """Return infos of a table [fields, n], and for each key who has it."""
        infos: dict[str, Any] = {}
        for key, values in zip(INFO_FIELDS, self._own(table), strict=True):
            infos[key] = values
            infos[f"_{key}"] = owners
        return infos

    def _as_tensors(self, infos: dict[str, Any]) -> dict[str, Any]:
        return {key: torch.from_numpy(value).to(self.device) for key, value in infos.items()}


def _read_mask(mask: Any) -> Any:
    """Return the mask of a reset, which may be a tensor, as an array."""
    if not isinstance(mask, Tensor):
        return mask
    check_plain(mask, "options['reset_mask']")
    if mask.dtype != torch.bool:
        raise TypeError(f"options['reset_mask'] must be of bool; got a tensor of {mask.dtype}")
    return mask.cpu().numpy()


def read_device(device: Any) -> torch.device:
    """Return the device that a text names.

    Raises:
        TypeError, ValueError: it names none of which the game knows.
        ImportError, RuntimeError: see `check_card`.
    """
    if not isinstance(device, str | torch.device):
        raise TypeError(f"device must be 'cuda', 'cuda:1', ... or 'cpu'; got {device!r}")
    try:
        found = torch.device(device)
    except RuntimeError:
        found = None
    if found is None or found.type not in ("cpu", "cuda"):
        raise ValueError(f"device must be 'cuda', 'cuda:1', ... or 'cpu'; got {device!r}")
    if found.type == "cpu":
        return torch.device("cpu")
    check_card(found)
    # With its number, as its tensors name it.
    index = torch.cuda.current_device() if found.index is None else found.index
    return torch.device("cuda", index)


def check_card(device: torch.device) -> None:
    """Check that games can be on a graphics card.

    Raises:
        ImportError: the package for cards is missing.
        RuntimeError: there is no such card, or the card or its driver is too old.
    """
    why = None
    if torch.version.cuda is None:
        why = "this torch was built without CUDA (pytorch.org says how to install the other one)"
    elif not torch.cuda.is_available():
        why = (
            "torch finds no NVIDIA card, or no driver that is new enough for CUDA "
            f"{torch.version.cuda} (nvidia-smi shows both)"
        )
    if why is not None:
        raise RuntimeError(
            f"device={str(device)!r}: {why}; without device=... the same games run on the processor"
        )
    count = torch.cuda.device_count()
    if device.index is not None and device.index >= count:
        there = "is 1 card, number 0" if count == 1 else f"are {count} cards, numbered from 0"
        raise RuntimeError(f"device={str(device)!r}: there {there}")
    if torch.cuda.get_device_capability(device) < (8, 0):
        raise RuntimeError(
            f"{torch.cuda.get_device_name(device)} is too old: the game's kernels need compute "
            "capability 8.0 (Ampere, 2020)"
        )
    # Before the kernels are compiled for half a minute.
    cuda_core()
