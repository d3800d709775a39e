"""A model as a policy, and the device where its network computes and its games are played."""

import sys
from functools import cache
from typing import Any

import numpy as np
import torch
from gymnasium import spaces
from numpy.typing import NDArray
from stable_baselines3 import PPO
from stable_baselines3.common.policies import BasePolicy
from torch import Tensor
from tqdm import tqdm  # type: ignore[import-untyped]

from ...envs.tensor_vector_env import check_card
from ..experiment.errors import SettingsError
from ..experiment.settings import Experiment


def find_device(name: str) -> torch.device:
    """Return the device of the setting ``training.device``.

    Raises `SettingsError` if it is cuda, and torch finds none.
    """
    if name == "cpu":
        return torch.device("cpu")
    if torch.cuda.is_available():
        return torch.device("cuda")
    if name == "cuda":
        version = torch.version.cuda
        why = f"none found, or its driver is too old for CUDA {version}"
        if version is None:
            why = "this torch is built without CUDA"
        raise SettingsError(
            f"'training.device' = 'cuda' needs a graphics card of NVIDIA ({why}): take 'auto' or "
            "'cpu'"
        )
    return torch.device("cpu")


def worlds_device(experiment: Experiment) -> str | None:
    """Return the device where the worlds of a training are; None: this processor, with arrays.

    They are where the network is, if the trainer can make use of it.
    """
    if experiment.training.trainer != "fast" or experiment.curriculum.sampling != "uniform":
        return None
    return device_beside(find_device(experiment.training.device))


def device_beside(network: torch.device) -> str | None:
    """Return the device where worlds are whose network is on one; None: here, with arrays.

    They are on the same graphics card, if that can play them; if not, a line says why.
    """
    if network.type != "cuda":
        return None
    try:
        check_card(network)
    except (ImportError, RuntimeError) as error:
        _tell(f"arkanoid: the games are played by the processor: {error}")
        return None
    return network.type


@cache
def _tell(message: str) -> None:
    """Write a line beside the progress bar, once."""
    tqdm.write(message, file=sys.stderr)


class ModelPolicy:
    """A model as a policy.

    Args:
        model: may change between two calls.
        deterministic: whether to take the likeliest action or to draw one.
        seed: of the draws, which leave torch's own random numbers alone.
        device: where the worlds are that it is measured in; None: here, with arrays.
    """

    def __init__(
        self,
        model: PPO | BasePolicy,
        deterministic: bool,
        seed: int,
        device: str | None = None,
    ) -> None:
        self.device = device
        self._network: Any = model if isinstance(model, BasePolicy) else model.policy
        self._deterministic = deterministic
        self._device = torch.device(model.device)
        self._random = torch.Generator(self._device).manual_seed(seed).get_state()

    def __call__(self, observations: Any, worlds: NDArray[Any]) -> NDArray[Any]:
        """Return the actions for observations [n, ...], arrays or tensors.

        Raises `SettingsError` if the network's output is not finite, or it cannot take these
        observations.
        """
        try:
            if self._deterministic:
                return self._choose(observations)
            on_card = self._device.type == "cuda"
            random: Any = torch.cuda if on_card else torch.random
            with torch.random.fork_rng(devices=[self._device] if on_card else []):
                random.set_rng_state(self._random)
                actions = self._choose(observations)
                self._random = random.get_rng_state()
            return actions
        except ValueError as error:
            reason = str(error).strip().partition("\n")[0]
            raise SettingsError(f"the model cannot play: {reason}") from None

    def _choose(self, observations: Any) -> NDArray[Any]:
        network = self._network
        if not isinstance(observations, Tensor):
            actions: NDArray[Any] = network.predict(
                observations, deterministic=self._deterministic
            )[0]
            return actions
        # As `predict`, which takes no tensors.
        network.set_training_mode(False)
        with torch.no_grad():
            chosen = network._predict(network_input(network, observations), self._deterministic)
        actions, space = chosen.cpu().numpy(), network.action_space
        if not isinstance(space, spaces.Box):
            return np.asarray(actions)
        if network.squash_output:
            return np.asarray(network.unscale_action(actions))
        return np.asarray(np.clip(actions, space.low, space.high))


def network_input(network: Any, observations: Any) -> Any:
    """Return observations [n, ...], arrays or tensors, as a network takes them.

    Raises ValueError if it is for observations of another form.
    """
    if not isinstance(observations, Tensor):
        return network.obs_to_tensor(observations)[0]
    shape = network.observation_space.shape
    if observations.shape[1:] != shape:
        raise ValueError(
            f"it takes observations of shape {shape}, not {tuple(observations.shape[1:])}"
        )
    return observations.to(network.device)
