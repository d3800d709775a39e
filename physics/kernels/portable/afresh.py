"""The program that prints the machine-independent code of entries; `entries` runs it."""

import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any

import llvmlite.binding as llvm

from .entries import Entry

_TYPES = "(int64, int64)"


def _compile(entry: Entry) -> Any:
    """Return LLVM's module of an entry; its function gets the entry's name."""
    kernel = getattr(import_module(entry.module), entry.name)
    kernel.compile(_TYPES)
    (signature,) = kernel.signatures
    function = kernel.overloads[signature].fndesc.llvm_func_name
    module = llvm.parse_assembly(kernel.inspect_llvm(signature))
    for each in module.functions:
        # Entries share what they call; what only this one has, Python's way in say, is its own.
        if not each.is_declaration and each.name != function and each.linkage.name == "external":
            each.linkage = "internal"
    module.get_function(function).name = entry.name
    return module


def _main(names: Sequence[str]) -> None:
    """Print the code of all entries as one module."""
    entries = [Entry(*name.split(":")) for name in names]
    first, *others = [_compile(entry) for entry in entries]
    for module in others:
        first.link_in(module)
    sys.stdout.write(str(first))


if __name__ == "__main__":
    _main(sys.argv[1:])
