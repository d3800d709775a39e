"""Entries as a module of WebAssembly, which every browser runs.

LLVM makes it of the very code that Numba makes for this processor, so that it gives the same bits:
WebAssembly rounds as IEEE 754 says, and can't join a multiplication and an addition. The module
imports nothing. It exports its memory, and for each entry a function ``NAME(index, address)`` of
32-bit integers. An address is a place in the memory.
"""

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

import llvmlite.binding as llvm

from .entries import Entry, compile_entries
from .kept import Product, make_once, sources_of
from .retarget import retarget

# The module's stack and constants lie below this address. What lies above is for its user.
FREE_FROM = 1 << 20
_STACK = 1 << 18  # bytes

_WASM = Product(
    "wasm", "browsers", b"ARKAWASM", 1, ("wasm.py", "afresh.py", "entries.py", "retarget.py")
)
_TRIPLE = "wasm32-unknown-unknown"
# What all browsers have had since 2023.
_FEATURES = "+bulk-memory,+mutable-globals,+nontrapping-fptoint,+sign-ext,+simd128"

_EXPORT = """
define void @{name}_export(i32 %index, i32 %address) "wasm-export-name"="{name}" {{
  %result = alloca ptr
  %error = alloca ptr
  %index64 = sext i32 %index to i64
  %address64 = zext i32 %address to i64
  call i32 @{name}(ptr %result, ptr %error, i64 %index64, i64 %address64)
  ret void
}}
"""
_LINK = (
    *("--no-entry", "--gc-sections", "--strip-all"),
    # A stack that overflows leaves the memory, instead of overwriting constants.
    *("--stack-first", "-z", f"stack-size={_STACK}"),
    # The linker refuses more than fits below.
    f"--initial-memory={FREE_FROM}",
)


def make_wasm(entries: Sequence[Entry]) -> bytes:
    """Return the module of entries.

    It is kept with the machine code of other kernels, for as long as no source changes.

    Args:
        entries: all of one file.

    Raises:
        ImportError: there is no linker.
        RuntimeError: the entries could not be compiled or linked.
    """
    return make_once(_WASM, entries, lambda: _make(entries))


def wasm_sources(entries: Sequence[Entry]) -> str:
    """Return a digest, of 16 letters, of all sources that the module of entries is made of.

    Args:
        entries: all of one file.
    """
    return sources_of(_WASM, entries)


def _make(entries: Sequence[Entry]) -> bytes:
    linker = _find_linker()
    # Numba's passes would write the sizes of this processor's pointers into the code.
    return _link(linker, _assemble(compile_entries(entries, optimised=False), entries))


def _assemble(code: str, entries: Sequence[Entry]) -> bytes:
    """Return the object file of the code of entries."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    target = llvm.Target.from_triple(_TRIPLE)
    machine = target.create_target_machine(features=_FEATURES, opt=3)
    text = retarget(code, _TRIPLE, str(machine.target_data))
    exports = [_EXPORT.format(name=entry.name) for entry in entries]
    module = llvm.parse_assembly("".join((text, *exports)))
    exported = {f"{entry.name}_export" for entry in entries}
    for each in (*module.functions, *module.global_variables):
        if not each.is_declaration and each.name not in exported:
            each.linkage = "internal"
    options = llvm.create_pipeline_tuning_options(speed_level=3)
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)
    return bytes(machine.emit_object(module))


def has_linker() -> bool:
    """Return whether a module can be made here."""
    try:
        _find_linker()
    except ImportError:
        return False
    return True


def _find_linker() -> list[str]:
    """Return the command of LLVM's linker for WebAssembly."""
    if find_spec("ziglang") is not None:
        return [sys.executable, "-m", "ziglang", "wasm-ld"]
    found = shutil.which("wasm-ld")
    if found is None:
        raise ImportError(
            'to make the game for browsers needs the linker wasm-ld: pip install "arkanoid[web]" '
            "brings it, and so does Debian's package lld"
        )
    return [found]


def _link(linker: Sequence[str], compiled: bytes) -> bytes:
    """Return the module of an object file."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "entries.o"), Path(folder, "entries.wasm")
        source.write_bytes(compiled)
        command = [*linker, *_LINK, str(source), "-o", str(target)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"the kernels could not be linked for browsers:\n{done.stderr}")
        return target.read_bytes()
