"""Kernels for other machines than this processor: graphics cards and browsers.

An *entry* is a kernel ``(index, address) -> None``: it does the work of one item, a world say,
whose arrays it finds by the numbers and addresses of a record that lies at ``address``. That is
all that a machine has to know to run it. `array_at` makes arrays of addresses, `on_stack` small
ones that are forgotten. `ptx.make_ptx` compiles entries for graphics cards, where
`cuda.CudaKernels` runs them; `wasm.make_wasm` compiles them for browsers.
"""

from .addresses import array_at, on_stack
from .entries import Entry

__all__ = ["Entry", "array_at", "on_stack"]
