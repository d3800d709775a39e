"""The module of the game's kernels that browsers load."""

from ...physics.kernels.portable.wasm import make_wasm
from .entries import ENTRIES


def make_module() -> bytes:
    """Return the module; it is kept for as long as no source of a kernel changes.

    Raises:
        ImportError: there is no linker for WebAssembly.
    """
    return make_wasm(ENTRIES)
