"""The environment of an experiment: many worlds in one native vector environment."""

from typing import Any

import gymnasium as gym
from gymnasium.vector import VectorEnv

from .schema import SettingsError
from .settings import Experiment


def make_worlds(experiment: Experiment, num_worlds: int, **extra: Any) -> VectorEnv[Any, Any, Any]:
    """Return ``num_worlds`` worlds that start a new episode in the step that ends one.

    ``extra`` goes beyond the experiment's ``[env]`` table, and before it. The observations that
    the environment returns are overwritten by its next step. Raises `SettingsError` if the
    environment refuses its arguments.
    """
    arguments = {"copy": False, **experiment.env, **extra, "autoreset_mode": "SameStep"}
    try:
        return gym.make_vec(
            experiment.env_id,
            num_envs=num_worlds,
            vectorization_mode="vector_entry_point",
            **arguments,
        )
    except (TypeError, ValueError, gym.error.Error) as error:
        raise SettingsError(f"{experiment.env_id} refuses the [env] table: {error}") from error
