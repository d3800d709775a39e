"""The game's module: as it comes with the package, or made here.

Distributions hold the module, so that their users need no linker. ``python -m
arkanoid.envs.browser.shipped`` writes it before they are built; git does not keep it.
"""

from pathlib import Path

from ...physics.kernels.portable.wasm import has_linker, make_wasm, wasm_sources
from ...physics.kernels.sealed import unseal, write_sealed
from .entries import ENTRIES

FILE = Path(__file__).with_name("module.sealed")
_MARK = b"ARKASHIP"
_VERSION = 1


def game_module() -> bytes:
    """Return the module of `ENTRIES`.

    Raises:
        ImportError, RuntimeError: it did not come with the package, or was made of other sources;
            and it can't be made here, see `make_wasm`.
    """
    sources = wasm_sources(ENTRIES).encode()
    try:
        content = bytes(unseal("module of the game", _MARK, _VERSION, FILE.read_bytes()))
    except (OSError, ValueError):
        return make_wasm(ENTRIES)
    return content[len(sources) :] if content.startswith(sources) else make_wasm(ENTRIES)


def offers_module() -> bool:
    """Return whether the module came with the package, or can be made; so pages can be offered."""
    return FILE.exists() or has_linker()


def ship_module() -> None:
    """Write the module into the package's folder, for distributions.

    Raises:
        ImportError, RuntimeError: see `make_wasm`.
        OSError: it can't be written.
    """
    content = wasm_sources(ENTRIES).encode() + make_wasm(ENTRIES)
    write_sealed(FILE, _MARK, _VERSION, content)


if __name__ == "__main__":
    ship_module()
