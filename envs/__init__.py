"""The game and its Gymnasium environments, on nothing but the engine."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .arkanoid_env import ArkanoidEnv
    from .vector_env import ArkanoidVectorEnv

__all__ = ["ArkanoidEnv", "ArkanoidVectorEnv"]


def __getattr__(name: str) -> Any:
    # Lazily, for registering the environments needs none of the kernels.
    if name == "ArkanoidEnv":
        from .arkanoid_env import ArkanoidEnv

        return ArkanoidEnv
    if name == "ArkanoidVectorEnv":
        from .vector_env import ArkanoidVectorEnv

        return ArkanoidVectorEnv
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
