"""The game and its Gymnasium environments, built on nothing but the engine."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .arkanoid_env import ArkanoidEnv
    from .batch.playback import ReplayDivergedError, play_replay, replay_frames
    from .batch.replays import Replay
    from .batch.transitions import Transition, replay_transitions
    from .vector_env import ArkanoidVectorEnv

__all__ = [
    "ArkanoidEnv",
    "ArkanoidVectorEnv",
    "Replay",
    "ReplayDivergedError",
    "Transition",
    "play_replay",
    "replay_frames",
    "replay_transitions",
]

_MODULES = {
    "ArkanoidEnv": "arkanoid_env",
    "ArkanoidVectorEnv": "vector_env",
    "Replay": "batch.replays",
    "ReplayDivergedError": "batch.playback",
    "Transition": "batch.transitions",
    "play_replay": "batch.playback",
    "replay_frames": "batch.playback",
    "replay_transitions": "batch.transitions",
}


def __getattr__(name: str) -> Any:
    # Imported on demand: registering the environments needs none of the kernels.
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f".{_MODULES[name]}", __name__), name)
