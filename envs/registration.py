"""The environments' ids, and the configuration that an id stands for."""

from collections.abc import Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

import gymnasium as gym
from gymnasium.envs.registration import EnvSpec, load_env_creator

if TYPE_CHECKING:
    from .config import Config

_PACKAGE = __name__.rpartition(".")[0]
_ENTRY_POINT = f"{_PACKAGE}.arkanoid_env:ArkanoidEnv"
_VECTOR_ENTRY_POINT = f"{_PACKAGE}.vector_env:ArkanoidVectorEnv"

# Keywords of `ArkanoidVectorEnv` that are no part of a `Config`.
BATCH_KEYWORDS = ("render_mode", "autoreset_mode", "copy", "threads")


def register_environments() -> None:
    """Register the environments with Gymnasium; what is already there stays, without a warning."""
    games: dict[str, dict[str, Any]] = {
        "Arkanoid-v0": {},
        # The simplest to learn.
        "ArkanoidLite-v0": {"actions": "discrete3", "capsules": False, "enemies": False},
    }
    for name, keywords in games.items():
        if name not in gym.registry:
            gym.register(
                id=name,
                entry_point=_ENTRY_POINT,
                vector_entry_point=_VECTOR_ENTRY_POINT,
                kwargs=keywords,
            )


def resolve_config(env_id: str, keywords: Mapping[str, Any]) -> "Config":
    """Return the configuration that `gym.make_vec(env_id, **keywords)` plays with.

    Args:
        env_id: a registered id whose vector environment is `ArkanoidVectorEnv` or derives from it.
            ``"module:id"`` imports the module first, as Gymnasium does.
        keywords: they win over those that the id was registered with.

    Raises:
        gymnasium.error.Error: no such id is registered.
        ImportError: the id's module cannot be imported.
        TypeError, ValueError: the id is of another environment, or a keyword is unknown or illegal.
    """
    # Imported on demand: registering the environments needs no configuration.
    from .config import Config

    module, _, name = env_id.rpartition(":")
    if module:
        import_module(module)
    spec = gym.spec(name)
    if not _is_ours(spec):
        raise ValueError(f"the vector_entry_point of {name} is not an ArkanoidVectorEnv")
    resolved = {**spec.kwargs, **keywords}
    return Config.from_keywords(
        {key: value for key, value in resolved.items() if key not in BATCH_KEYWORDS}
    )


def _is_ours(spec: EnvSpec) -> bool:
    entry_point = spec.vector_entry_point
    if entry_point is None:
        return False
    if entry_point == _VECTOR_ENTRY_POINT:
        return True  # without importing the kernels
    creator = load_env_creator(entry_point) if isinstance(entry_point, str) else entry_point
    from .vector_env import ArkanoidVectorEnv

    return isinstance(creator, type) and issubclass(creator, ArkanoidVectorEnv)
