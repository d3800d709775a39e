"""The game and its Gymnasium environments, on nothing but the engine."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .arkanoid_env import ArkanoidEnv
    from .batch.playback import ReplayDivergedError, play_replay, replay_frames
    from .batch.replays import Replay
    from .vector_env import ArkanoidVectorEnv

__all__ = [
    "ArkanoidEnv",
    "ArkanoidVectorEnv",
    "Replay",
    "ReplayDivergedError",
    "play_replay",
    "replay_frames",
]

_HOMES = {
    "ArkanoidEnv": "arkanoid_env",
    "ArkanoidVectorEnv": "vector_env",
    "Replay": "batch.replays",
    "ReplayDivergedError": "batch.playback",
    "play_replay": "batch.playback",
    "replay_frames": "batch.playback",
}


def __getattr__(name: str) -> Any:
    # Lazily, for registering the environments needs none of the kernels.
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_HOMES[name]}", __name__), name)
