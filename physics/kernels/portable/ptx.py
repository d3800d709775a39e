"""Entries as PTX, the assembly of NVIDIA's graphics cards.

LLVM makes it of the very code that Numba makes for this processor, so that the card gives the same
bits: a multiplication and an addition are never joined, and divisions and square roots round as
IEEE 754 says. A thread of the card runs an entry for one item.
"""

import re
from collections.abc import Sequence

import llvmlite.binding as llvm

from .entries import Entry, compile_entries
from .kept import Product, make_once
from .retarget import retarget

# Every card since Ampere (2020) runs it.
ARCHITECTURE = "sm_80"

_PTX = Product(
    "ptx", "graphics cards", b"ARKAPTX\0", 1, ("ptx.py", "afresh.py", "entries.py", "retarget.py")
)
_TRIPLE = "nvptx64-nvidia-cuda"

# A kernel of the card for each entry. Its threads may be more than there are items.
_KERNEL = """
define ptx_kernel void @{name}_kernel(i64 %count, i64 %address) {{
  %thread = call i32 @llvm.nvvm.read.ptx.sreg.tid.x()
  %block = call i32 @llvm.nvvm.read.ptx.sreg.ctaid.x()
  %size = call i32 @llvm.nvvm.read.ptx.sreg.ntid.x()
  %block64 = zext i32 %block to i64
  %size64 = zext i32 %size to i64
  %thread64 = zext i32 %thread to i64
  %first = mul i64 %block64, %size64
  %index = add i64 %first, %thread64
  %exists = icmp slt i64 %index, %count
  br i1 %exists, label %work, label %end
work:
  %result = alloca i64
  %error = alloca ptr
  call i32 @{name}(ptr %result, ptr %error, i64 %index, i64 %address)
  br label %end
end:
  ret void
}}
"""
# LLVM would copy a record byte by byte on the card, whatever is known of its alignment. Records lie
# as in C, and none overlaps another.
_COPY_OF_BYTES = re.compile(
    r"(?:tail )?call void @llvm\.mem(?:move|cpy)\.p0\.p0\.i64\(ptr [^%@]*(?P<target>[%@][\w.]+), "
    r"ptr [^%@]*(?P<source>[%@][\w.]+), i64 (?P<size>\d+), i1 false\)"
)
_LEAST_COPY = 64  # bytes
# Four words at once, so that the card does not wait for each; without "no-builtins" LLVM would make
# it what it replaces.
_COPY = """
define internal void @copy_words(ptr noalias %target, ptr noalias %source, i64 %words)
    noinline "no-builtins" {{
  br label %test
test:
  %word = phi i64 [ 0, %0 ], [ %next, %four ], [ %following, %one ]
  %left = sub i64 %words, %word
  %many = icmp sge i64 %left, 4
  br i1 %many, label %four, label %few
four:
  %s0 = getelementptr i64, ptr %source, i64 %word
{loads}
  %t0 = getelementptr i64, ptr %target, i64 %word
{stores}
  %next = add i64 %word, 4
  br label %test
few:
  %any = icmp sge i64 %left, 1
  br i1 %any, label %one, label %end
one:
  %from = getelementptr i64, ptr %source, i64 %word
  %value = load i64, ptr %from, align 8
  %to = getelementptr i64, ptr %target, i64 %word
  store i64 %value, ptr %to, align 8
  %following = add i64 %word, 1
  br label %test
end:
  ret void
}}
""".format(
    loads="\n".join(
        f"  %p{n} = getelementptr i64, ptr %s0, i64 {n}\n  %v{n} = load i64, ptr %p{n}, align 8"
        for n in range(4)
    ),
    stores="\n".join(
        f"  %q{n} = getelementptr i64, ptr %t0, i64 {n}\n  store i64 %v{n}, ptr %q{n}, align 8"
        for n in range(4)
    ),
)
_PLACES = "\n".join(
    f"declare i32 @llvm.nvvm.read.ptx.sreg.{name}.x()" for name in ("tid", "ctaid", "ntid")
)


def make_ptx(entries: Sequence[Entry]) -> str:
    """Return the PTX of entries, each a kernel ``NAME_kernel(count, address)``.

    It is kept with the machine code of other kernels, for as long as no source changes.

    Args:
        entries: all of one file.

    Raises:
        RuntimeError: the entries could not be compiled.
    """
    return make_once(_PTX, entries, lambda: _make(entries)).decode()


def _make(entries: Sequence[Entry]) -> bytes:
    return _assemble(compile_entries(entries), entries).encode()


def _assemble(code: str, entries: Sequence[Entry]) -> str:
    """Return PTX of the code of entries."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    # Never join a multiplication and an addition: it would round once instead of twice.
    llvm.set_option("", "-nvptx-fma-level=0")
    machine = llvm.Target.from_triple(_TRIPLE).create_target_machine(cpu=ARCHITECTURE, opt=3)
    kernels = [_KERNEL.format(name=entry.name) for entry in entries]
    text = _COPY_OF_BYTES.sub(_copy_of_words, retarget(code, _TRIPLE, str(machine.target_data)))
    module = llvm.parse_assembly("".join((text, _COPY, _PLACES, *kernels)))
    for entry in entries:
        module.get_function(entry.name).linkage = "internal"
    options = llvm.create_pipeline_tuning_options(speed_level=3)
    # The card's threads are its vectors.
    options.loop_vectorization = options.slp_vectorization = False
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)
    return str(machine.emit_assembly(module))


def _copy_of_words(call: "re.Match[str]") -> str:
    """Return the call that copies a record word by word, or the one that was found."""
    size = int(call["size"])
    if size % 8 or size < _LEAST_COPY:
        return call[0]
    return f"call void @copy_words(ptr {call['target']}, ptr {call['source']}, i64 {size // 8})"
