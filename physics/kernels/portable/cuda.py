"""Entries on NVIDIA's graphics cards, by the driver's own interface (the package ``cuda-core``)."""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

from .entries import Entry
from .ptx import make_ptx


class CudaKernels:
    """Entries on one card.

    Args:
        entries: each is what a thread does for an item.
        card: its number.

    Raises:
        ImportError: the package ``cuda-core`` is missing.
        MemoryError: the card has too little memory left.
        RuntimeError: the entries could not be compiled, or the card or its driver refuses them.
    """

    def __init__(self, entries: Sequence[Entry], card: int) -> None:
        self._core, self._card = cuda_core(), card
        ptx = make_ptx(entries)
        try:
            self._core.Device(card).set_current()
            self._code = self._core.ObjectCode.from_ptx(ptx.encode())
            self._kernels = {
                entry: self._code.get_kernel(f"{entry.name}_kernel") for entry in entries
            }
        except Exception as error:  # each version of the package has classes of its own
            _raise_if_memory(card, error)
            raise RuntimeError(
                f"the graphics card {card} refuses the game's kernels ({error}): it needs compute "
                "capability 8.0 and a driver for CUDA 12 or newer"
            ) from error
        self._streams: dict[int, Any] = {}

    def launcher(self, entry: Entry, threads: int) -> Callable[[int, int, int], None]:
        """Return what lets the card run an entry, without waiting for it.

        It takes the number of items; the address of the entry's record, in the card's memory; and
        the handle of the stream whose earlier work must be done before.

        It raises a MemoryError if the card has no room for the threads' stacks, and a RuntimeError
        if it refuses for another reason.

        Args:
            threads: of a block.
        """
        core, kernel, streams = self._core, self._kernels[entry], self._streams
        card = self._card

        def launch(count: int, address: int, stream: int) -> None:
            if stream not in streams:
                streams[stream] = core.Stream.from_handle(stream)
            config = core.LaunchConfig(grid=-(-count // threads), block=threads)
            try:
                core.launch(streams[stream], config, kernel, count, address)
            except Exception as error:
                _raise_if_memory(card, error)
                raise RuntimeError(
                    f"the graphics card {card} does not run the game's kernels ({error})"
                ) from error

        return launch


def _raise_if_memory(card: int, error: Exception) -> None:
    """Raise a MemoryError if this is why a card refuses."""
    if "OUT_OF_MEMORY" in str(error).upper().replace(" ", "_"):
        raise MemoryError(
            f"the graphics card {card} has too little memory left for the game's kernels, whose "
            f"threads need about a gigabyte ({error}): take fewer games, or free what torch keeps, "
            "with torch.cuda.empty_cache()"
        ) from error


@cache
def cuda_core() -> Any:
    """Return the package.

    Raises ImportError if it is missing.
    """
    try:
        import cuda.core as core  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ImportError as error:
        raise ImportError(
            "games on a graphics card need the package cuda-core: "
            'pip install "arkanoid[gpu]" brings it'
        ) from error
    return core
