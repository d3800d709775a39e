"""The environments' ids."""

from typing import Any

import gymnasium as gym


def register_environments() -> None:
    """Register the environments with Gymnasium; what is already there stays, without a warning."""
    package = __name__.rpartition(".")[0]
    games: dict[str, dict[str, Any]] = {
        "Arkanoid-v0": {},
        # The simplest to learn.
        "ArkanoidLite-v0": {"actions": "discrete3", "capsules": False, "enemies": False},
    }
    for name, keywords in games.items():
        if name not in gym.registry:
            gym.register(
                id=name,
                entry_point=f"{package}.arkanoid_env:ArkanoidEnv",
                vector_entry_point=f"{package}.vector_env:ArkanoidVectorEnv",
                kwargs=keywords,
            )
