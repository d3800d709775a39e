"""Which observer a configuration asks for."""

from ..config import Config
from .protocol import Observer


def make_observer(config: Config, num_worlds: int) -> Observer:
    """Return the observer of the kind that a configuration asks for."""
    # Imported on demand: each kind has kernels that the others do not need.
    if config.observation == "grid":
        from .planes import GridObserver

        return GridObserver(config, num_worlds)
    if config.observation == "rgb":
        from .pixels import PixelObserver

        return PixelObserver(config, num_worlds)
    if config.observation == "dict":
        from .both import DictObserver

        return DictObserver(config, num_worlds)
    from .vector import VectorObserver

    return VectorObserver(config, num_worlds)
