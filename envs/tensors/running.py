"""How entries run where a batch's tensors are."""

from collections.abc import Callable
from importlib import import_module

import torch

from ...physics.kernels.portable import Entry

# Takes how many items there are, and the address of the entry's record.
Run = Callable[[int, int], None]


def runner(entry: Entry, device: torch.device) -> Run:
    """Return what runs an entry on a device.

    Raises:
        ImportError, RuntimeError: see `CudaKernel`.
    """
    if device.type == "cpu":
        kernel = getattr(import_module(entry.module), entry.name)

        def run_here(count: int, address: int) -> None:
            for index in range(count):
                kernel(index, address)

        return run_here
    # Imported on demand: it needs a package that only cards do.
    from ...physics.kernels.portable.cuda import CudaKernel

    card = torch.cuda.current_device() if device.index is None else device.index
    on_card = CudaKernel(entry, card)

    def run_there(count: int, address: int) -> None:
        on_card.launch(count, address, torch.cuda.current_stream(device).cuda_stream)

    return run_there
