"""How entries run where a batch's tensors are."""

from collections.abc import Callable, Sequence
from importlib import import_module

import torch

from ...physics.kernels.portable import Entry

# Takes how many items there are, and the address of the entries' record.
RunEntry = Callable[[int, int], None]


class Runs:
    """Entries, ready to run on a device.

    Args:
        entries: of one file.
        device: if it is a card, with its index.

    Raises:
        ImportError, MemoryError, RuntimeError: see `CudaKernels`.
    """

    def __init__(self, entries: Sequence[Entry], device: torch.device) -> None:
        self._device = device
        self._on_card = None
        if device.type == "cuda":
            # Imported on demand: it needs a package that only cards do.
            from ...physics.kernels.portable.cuda import CudaKernels

            # Torch goes on with the card that it had before.
            with torch.cuda.device(device):
                self._on_card = CudaKernels(entries, device.index)

    def of(self, entry: Entry, threads: int) -> RunEntry:
        """Return what runs one of them; threads: of a block, on a card."""
        if self._on_card is None:
            kernel = getattr(import_module(entry.module), entry.name)

            def run_here(count: int, address: int) -> None:
                for index in range(count):
                    kernel(index, address)

            return run_here
        launch, device = self._on_card.launcher(entry, threads), self._device

        def run_there(count: int, address: int) -> None:
            # A stream may be the default one, which each card has.
            with torch.cuda.device(device):
                try:
                    launch(count, address, torch.cuda.current_stream(device).cuda_stream)
                except MemoryError as error:
                    # Callers know torch's own error for it.
                    raise torch.OutOfMemoryError(str(error)) from error

        return run_there
