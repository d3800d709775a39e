"""The environments' ids."""

import gymnasium as gym


def register_environments() -> None:
    """Register the environments with Gymnasium; what is already there stays, without a warning."""
    package = __name__.rpartition(".")[0]
    if "Arkanoid-v0" not in gym.registry:
        gym.register(
            id="Arkanoid-v0",
            entry_point=f"{package}.arkanoid_env:ArkanoidEnv",
            vector_entry_point=f"{package}.vector_env:ArkanoidVectorEnv",
        )
