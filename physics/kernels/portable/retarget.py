"""LLVM's code of entries, turned from this processor to another machine."""

import re

# Numba's code would call it to free an array's memory. What entries work on is never freed.
_FREES = re.compile(r"^declare ([^\n]*@NRT_MemInfo_call_dtor)\([^\n]*$", re.MULTILINE)
_NEVER = r"define internal \1(ptr %array) { unreachable }"


def retarget(code: str, triple: str, layout: str) -> str:
    """Return code for another machine, without what is this processor's.

    Args:
        triple: LLVM's name of the machine.
        layout: how it lays out data, in LLVM's words.
    """
    code = re.sub(r"^target datalayout = .*$", f'target datalayout = "{layout}"', code, flags=re.M)
    code = re.sub(r"^target triple = .*$", f'target triple = "{triple}"', code, flags=re.M)
    code = re.sub(r'"(target-cpu|target-features|tune-cpu|probe-stack)"="[^"]*"', "", code)
    code = _FREES.sub(_NEVER, code)
    # The machine has no library of C, but square roots of its own.
    return re.sub(r"\bcall ([^\n]*?)double @sqrt\(", r"call \1double @llvm.sqrt.f64(", code)
