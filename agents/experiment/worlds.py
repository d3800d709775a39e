"""The environment of an experiment: many worlds in one native vector environment."""

from collections.abc import Collection
from typing import Any

import gymnasium as gym
from gymnasium.vector import VectorEnv

from .schema import SettingsError
from .settings import Experiment


def native(worlds: VectorEnv[Any, Any, Any]) -> Any:
    """Return the environment itself, with what only ours has: `config`, `layout`, snapshots."""
    return worlds.unwrapped


def make_worlds(
    experiment: Experiment, num_worlds: int, without: Collection[str] = (), **extra: Any
) -> VectorEnv[Any, Any, Any]:
    """Return ``num_worlds`` worlds that start a new episode in the step that ends one.

    ``extra`` goes beyond the experiment's ``[env]`` table, of which the keys ``without`` are left
    out, and before it. The observations that the environment returns are overwritten by its next
    step. Raises `SettingsError` if the environment refuses its arguments.
    """
    table = {key: value for key, value in experiment.env.items() if key not in without}
    arguments = {"copy": False, **table, **extra, "autoreset_mode": "SameStep"}
    try:
        return gym.make_vec(
            experiment.env_id,
            num_envs=num_worlds,
            vectorization_mode="vector_entry_point",
            **arguments,
        )
    except (TypeError, ValueError, gym.error.Error) as error:
        raise SettingsError(f"{experiment.env_id} refuses the [env] table: {error}") from error
