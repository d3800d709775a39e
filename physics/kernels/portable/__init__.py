"""Kernels for other machines than this processor: a graphics card, and what else LLVM knows.

An *entry* is a kernel ``(index, address) -> None``: it does the work of one item, a world say,
whose arrays it finds by the numbers and addresses of a record that lies at ``address``. That is all
that a machine has to know to run it. `array_at` makes arrays of addresses, `find_entry` names an
entry, `make_ptx` compiles entries for a graphics card, and `CudaDevice` runs them there.
"""

from .addresses import array_at
from .entries import Entry

__all__ = ["Entry", "array_at"]
