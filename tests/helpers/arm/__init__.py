"""Runs entries on an AArch64 processor, which QEMU plays.

Their code is what Numba makes of them for this processor, turned to the other one by LLVM, as Numba
itself would on a machine that has it. The program is kept with the machine code of kernels, for as
long as no source changes.
"""

import hashlib
import importlib.util
import os
import shutil
import struct
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

import llvmlite.binding as llvm
import pytest
from arkanoid.physics.kernels.portable import Entry
from arkanoid.physics.kernels.portable.entries import compile_entries
from arkanoid.physics.kernels.portable.kept import Product, make_once
from arkanoid.physics.kernels.portable.retarget import retarget
from arkanoid.physics.kernels.portable.wasm import FREE_FROM

# Where it is set, as by `.ci/run`, tests fail that miss something; elsewhere they are skipped.
REQUIRED = "ARKANOID_TESTS_NEED_QEMU"
FIRST = FREE_FROM  # so that images for browsers are of use
SIZE = 1 << 24
_SOURCE = Path(__file__).with_name("program.c")
_OWN = hashlib.sha256(Path(__file__).read_bytes() + _SOURCE.read_bytes()).hexdigest()[:16]
_ARM = Product(
    f"arm-{_OWN}", "AArch64", b"ARKAARM\0", 1, ("afresh.py", "entries.py", "retarget.py")
)
_TRIPLE = "aarch64-unknown-linux-gnu"
_CALL, _PUT, _GET = range(3)
_ROW = struct.Struct("<4q")
_LINK = (
    *("-target", "aarch64-linux-none", "-O2", "-nostdlib", "-static", "-ffreestanding"),
    *("-fno-builtin", "-fno-sanitize=all", "-fno-stack-protector"),
    # Far above the memory.
    *("-Wl,--image-base=0x10000000", f"-DFIRST={FIRST}", f"-DSIZE={SIZE}"),
)


class ArmMachine:
    """A processor with memory from `FIRST` on. It works where `run` is called.

    Args:
        program: of `make_program`.
        entries: that it was made of.
    """

    def __init__(self, program: Path, entries: Sequence[Entry]) -> None:
        self._program = program
        self._numbers = {entry.name: number for number, entry in enumerate(entries)}
        self._rows: list[bytes] = []

    def call(self, name: str, address: int, index: int = 0) -> None:
        """Run an entry."""
        self._rows.append(_ROW.pack(_CALL, self._numbers[name], index, address))

    def put(self, address: int, content: bytes) -> None:
        """Write into the memory."""
        self._rows += [_ROW.pack(_PUT, address, len(content), 0), content]

    def get(self, address: int, length: int) -> None:
        """Let `run` return what lies in the memory at this time."""
        self._rows.append(_ROW.pack(_GET, address, length, 0))

    def run(self) -> bytes:
        """Do it all, in its order; return the bytes that were asked for."""
        command = [_qemu(), str(self._program)]
        rows = b"".join(self._rows)
        return subprocess.run(command, input=rows, stdout=subprocess.PIPE, check=True).stdout


def make_program(entries: Sequence[Entry], folder: Path) -> Path:
    """Return the program that runs entries; skip the test where QEMU or the compiler is missing.

    Args:
        entries: all of one file.
        folder: in which the program and its parts are written.
    """
    _qemu()
    if importlib.util.find_spec("ziglang") is None:
        _miss("no compiler here: the package ziglang is missing")
    program = folder / "program"
    program.write_bytes(make_once(_ARM, entries, lambda: _make(entries, folder)))
    program.chmod(0o755)
    return program


def _make(entries: Sequence[Entry], folder: Path) -> bytes:
    compiled, linked = folder / "entries.o", folder / "linked"
    compiled.write_bytes(_assemble(compile_entries(entries), entries))
    command = [sys.executable, "-m", "ziglang", "cc", *_LINK, str(_SOURCE), str(compiled)]
    kept = {f"ZIG_{kind}_CACHE_DIR": str(folder / "zig") for kind in ("GLOBAL", "LOCAL")}
    subprocess.run([*command, "-o", str(linked)], env=os.environ | kept, check=True)
    return linked.read_bytes()


def _qemu() -> str:
    found = shutil.which("qemu-aarch64")
    if found is None:
        _miss("no qemu-aarch64 here: Debian's package qemu-user has it")
    return found


def _miss(message: str) -> NoReturn:
    if os.environ.get(REQUIRED):
        pytest.fail(message)
    pytest.skip(message)


def _assemble(code: str, entries: Sequence[Entry]) -> bytes:
    """Return the object file of the code of entries, with their table."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    target = llvm.Target.from_triple(_TRIPLE)
    machine = target.create_target_machine(opt=3, reloc="static", codemodel="small")
    text = retarget(code, _TRIPLE, str(machine.target_data))
    table = ", ".join(f"ptr @{entry.name}" for entry in entries)
    table = f"\n@ENTRIES = constant [{len(entries)} x ptr] [{table}]\n"
    module = llvm.parse_assembly(text + table)
    for each in (*module.functions, *module.global_variables):
        if not each.is_declaration and each.name != "ENTRIES":
            each.linkage = "internal"
    options = llvm.create_pipeline_tuning_options(speed_level=3)
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)
    return bytes(machine.emit_object(module))
