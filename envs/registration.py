"""The environments' ids, and the configuration that an id stands for."""

from collections.abc import Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

import gymnasium as gym
from gymnasium.envs.registration import EnvSpec, load_env_creator

from .hints import BATCH_KEYWORDS

if TYPE_CHECKING:
    from .config import Config

_PACKAGE = __name__.rpartition(".")[0]
_ENTRY_POINT = f"{_PACKAGE}.arkanoid_env:ArkanoidEnv"
_VECTOR_ENTRY_POINT = f"{__name__}:make_vector_env"

# The simplest to learn.
_LITE: dict[str, Any] = {"actions": "discrete3", "capsules": False, "enemies": False}
_PIXELS: dict[str, Any] = {"observation": "rgb", "grey": True, "stack": 4}
# Like the Atari games of that name, for scripts that bring their own wrappers.
_NO_FRAMESKIP: dict[str, Any] = {
    "observation": "rgb",
    "size": (210, 160),
    "channels": "last",
    "actions": "discrete4",
    "frame_skip": 1,
    "max_decisions": 108_000,  # as many ticks as in the other games
}

# The keywords of each id. There is one for each kind of actions and of observations, because some
# tools take an id and nothing else.
GAMES: dict[str, dict[str, Any]] = {
    "Arkanoid-v0": {},
    "ArkanoidContinuous-v0": {"actions": "box"},
    "ArkanoidPixels-v0": _PIXELS,
    "ArkanoidNoFrameskip-v0": _NO_FRAMESKIP,
    "ArkanoidLite-v0": _LITE,
    "ArkanoidLiteContinuous-v0": _LITE | {"actions": "box"},
    "ArkanoidLitePixels-v0": _LITE | _PIXELS,
    "ArkanoidLiteNoFrameskip-v0": _LITE | _NO_FRAMESKIP,
}


def make_vector_env(num_envs: int = 1, device: Any = None, **keywords: Any) -> Any:
    """Return an `ArkanoidVectorEnv`, or with a device an `ArkanoidTensorVectorEnv`.

    Their keywords, and what they raise, are written there.
    """
    if device is not None:
        # Imported on demand: it imports torch.
        from .tensor_vector_env import ArkanoidTensorVectorEnv

        return ArkanoidTensorVectorEnv(device, num_envs, **keywords)
    from .vector_env import ArkanoidVectorEnv

    return ArkanoidVectorEnv(num_envs, **keywords)


def register_environments() -> None:
    """Register the environments with Gymnasium; what is already there stays, without a warning."""
    for name, keywords in GAMES.items():
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
    if creator is make_vector_env:
        return True
    from .vector_env import ArkanoidVectorEnv

    return isinstance(creator, type) and issubclass(creator, ArkanoidVectorEnv)
