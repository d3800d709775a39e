"""How code is compiled and kept, and bytes that can be kept: the ground that knows no geometry."""

from .decorators import accessor, inlined, inner, is_interpreted, kernel

__all__ = ["accessor", "inlined", "inner", "is_interpreted", "kernel"]
