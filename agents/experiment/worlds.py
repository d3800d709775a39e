"""The environment of an experiment: many worlds in one native vector environment."""

from typing import Any

import gymnasium as gym
from gymnasium.vector import VectorEnv

from ...envs.config import MOST_WORLDS, Config
from .errors import SettingsError
from .settings import Experiment


def native(worlds: VectorEnv[Any, Any, Any]) -> Any:
    """Return the `ArkanoidVectorEnv` itself, which has `config`, `layout` and snapshots."""
    return worlds.unwrapped


def make_worlds(
    experiment: Experiment,
    num_worlds: int,
    config: Config | None = None,
    render_mode: str | None = None,
    device: str | None = None,
) -> VectorEnv[Any, Any, Any]:
    """Return ``num_worlds`` worlds that start a new episode in the step that ends one.

    The next step overwrites the observations that the environment returns.

    Args:
        experiment: its ``env_id`` and ``[env]`` say which environment.
        num_worlds: how many.
        config: replaces the experiment's own configuration.
        render_mode: as for `gym.make_vec`.
        device: where the worlds are; None: in this processor's memory, as NumPy's arrays.

    Raises:
        SettingsError: the environment refuses its arguments, the device can't play the games, or
            so many worlds do not fit into memory.
    """
    too_many = f"not enough memory for {num_worlds:,} worlds at once"
    if num_worlds > MOST_WORLDS:
        raise SettingsError(too_many)
    resolved = experiment.config if config is None else config
    arguments = {
        "copy": False,
        **experiment.env,  # for what is no part of a configuration, such as `threads`
        **resolved.plain(),
        "render_mode": render_mode,
        "autoreset_mode": "SameStep",
    }
    if device is not None:
        arguments["device"] = device
    try:
        return gym.make_vec(
            experiment.env_id,
            num_envs=num_worlds,
            vectorization_mode="vector_entry_point",
            **arguments,
        )
    except (TypeError, ValueError, ImportError, RuntimeError, gym.error.Error) as error:
        if device is not None and isinstance(error, ImportError | RuntimeError):
            raise SettingsError(f"no games on {device}: {error}") from error
        raise SettingsError(f"{experiment.env_id} refuses the [env] table: {error}") from error
    except MemoryError:
        raise SettingsError(too_many) from None
