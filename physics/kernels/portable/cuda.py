"""Entries on NVIDIA's graphics cards, by the driver's own interface (the package ``cuda-core``)."""

from functools import cache
from typing import Any

from .entries import Entry
from .ptx import make_ptx

# Threads of a block. A thread needs nearly all registers that one may have, so that larger blocks
# would leave a part of the card without work.
_BLOCK = 32


class CudaKernel:
    """An entry on one card.

    Args:
        entry: what a thread does for each item.
        card: its number.

    Raises:
        ImportError: the package ``cuda-core`` is missing.
        RuntimeError: the entry could not be compiled, or the card or its driver refuses it.
    """

    def __init__(self, entry: Entry, card: int) -> None:
        self._core = _cuda_core()
        ptx = make_ptx([entry])
        try:
            self._core.Device(card).set_current()
            self._code = self._core.ObjectCode.from_ptx(ptx.encode())
            self._kernel = self._code.get_kernel(f"{entry.name}_kernel")
        except Exception as error:  # each version of the package has classes of its own
            raise RuntimeError(
                f"the graphics card {card} refuses the game's kernels ({error}): it needs compute "
                "capability 8.0 and a driver for CUDA 12 or newer"
            ) from error
        self._streams: dict[int, Any] = {}

    def launch(self, count: int, address: int, stream: int) -> None:
        """Let the card run the entry for ``count`` items, without waiting for it.

        Args:
            address: of the entry's record, in the card's memory.
            stream: the handle of the stream whose earlier work must be done before.
        """
        core = self._core
        if stream not in self._streams:
            self._streams[stream] = core.Stream.from_handle(stream)
        config = core.LaunchConfig(grid=-(-count // _BLOCK), block=_BLOCK)
        core.launch(self._streams[stream], config, self._kernel, count, address)


@cache
def _cuda_core() -> Any:
    """Return the package, from where it lies in its versions."""
    try:
        import cuda.core as core  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ImportError as error:
        raise ImportError(
            "games on a graphics card need the package cuda-core: "
            'pip install "arkanoid[gpu]" brings it'
        ) from error
    if hasattr(core, "Device"):
        return core
    import cuda.core.experimental as experimental  # type: ignore[import-untyped, import-not-found, unused-ignore]

    return experimental
