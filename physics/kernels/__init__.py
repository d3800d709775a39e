"""How kernels are compiled and cached, and how bytes are sealed: it knows no geometry."""

from .decorators import accessor, entry_of, inlined, inner, kernel
from .numba_internals import is_interpreted

__all__ = ["accessor", "entry_of", "inlined", "inner", "is_interpreted", "kernel"]
