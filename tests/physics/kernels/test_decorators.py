"""The decorators: what they compile, what they refuse, and what the user sees of it."""

from typing import Any

import numpy as np
import pytest
from arkanoid.physics import kernels
from helpers.scratch_package import Scratch
from numba.core.errors import NumbaError

# A kernel of a part that has a name.
PEN = """
from ...physics.callee import scaled
from ...physics.kernels import kernel

@kernel
def thick(x):
    return scaled(x) + 1.0
"""


def test_interpreted_is_the_function_itself(scratch: Scratch) -> None:
    program = """
import types
from arkanoid.envs.caller import shifted
assert type(shifted) is types.FunctionType
report(shifted(10.0))
"""
    outcome = scratch.run(program, NUMBA_DISABLE_JIT="1")
    assert (outcome.result, outcome.compiled, outcome.stderr) == (21.0, [], "")
    assert not scratch.cache.exists()


def test_function_without_a_file_is_compiled(scratch: Scratch) -> None:
    outcome = scratch.run("""
from arkanoid.physics.kernels import kernel
@kernel
def double(x):
    return x + x
report(double(4.0))
""")
    assert outcome.result == 8.0
    assert outcome.compiled == ["double"]


def test_second_import_under_another_name_compiles_nothing(scratch: Scratch) -> None:
    """The root is the package: tools may import it under its folder's name, too."""
    outcome = scratch.run("""
import importlib, importlib.util, sys
from arkanoid.envs.caller import shifted
first = shifted(10.0)
before = len(recorder.buffer)
place = importlib.util.find_spec("arkanoid")
spec = importlib.util.spec_from_file_location(
    "house", place.origin, submodule_search_locations=place.submodule_search_locations)
sys.modules["house"] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(sys.modules["house"])
again = importlib.import_module("house.envs.caller").shifted
assert again is not shifted
assert again(10.0) == first
assert len(recorder.buffer) == before
report(first)
""")
    assert outcome.result == 21.0
    assert len(outcome.stderr.splitlines()) == 1


def test_constants_do_not_compile_a_kernel_again(scratch: Scratch) -> None:
    """Numba compiled `impact_between` and all that it calls for each pair of the game's shapes.

    It makes a signature for every constant argument. With a dozen shapes, named by their numbers,
    the first step took a minute.
    """
    scratch.write(
        "constants.py",
        """
from arkanoid.physics.kernels import inlined, kernel

@kernel
def power(number, times):
    result = 1
    for _ in range(times):
        result *= number
    return result

@inlined
def cube(number):
    return power(number, times=3)

@kernel
def total(number):
    return power(number, 1) + power(2, 2) + power(number, number) + cube(number)
""",
    )
    run = scratch.run(
        "from constants import power, total; report([total(3), len(power.callee.signatures)])"
    )
    assert run.result == [3 + 4 + 27 + 27, 1]
    assert sorted(run.compiled) == ["power", "total"]


def test_an_inner_kernel_serves_kernels_and_refuses_python(scratch: Scratch) -> None:
    """It has no entry for Python: Numba would call a null pointer."""
    scratch.write(
        "inside.py",
        """
from arkanoid.physics.kernels import inner, kernel

@inner
def doubled(number):
    return number + number

@kernel
def quadrupled(number):
    return doubled(doubled(number))
""",
    )
    program = """
from inside import doubled, quadrupled
try:
    doubled(1)
except TypeError as error:
    report([quadrupled(2.5), str(error)])
"""
    for compiled in (["doubled", "quadrupled"], []):
        run = scratch.run(program)
        assert run.result[0] == 10.0
        assert run.result[1].startswith("doubled can be called by kernels only")
        assert sorted(run.compiled) == compiled


def test_a_kernel_that_allocates_does_not_compile() -> None:
    """Nor does one that returns an array; an accessor may. So a step counts no references.

    With a warm cache it did: the machine code of the accessor, which an earlier run had kept, was
    taken for the kernel's. So an accessor comes first here.
    """

    def allocates(size: int) -> float:
        return float(np.zeros(size)[0])

    def looks(values: Any) -> Any:
        return values[1:]

    assert kernels.accessor(looks)(np.arange(3.0)).tolist() == [1, 2]
    with pytest.raises(NumbaError):
        kernels.kernel(allocates)(3)
    with pytest.raises(NumbaError):
        kernels.kernel(looks)(np.arange(3.0))


def test_wait_is_announced_once_and_says_for_what(scratch: Scratch) -> None:
    scratch.write("arkanoid/envs/draw/__init__.py", "")
    scratch.write("arkanoid/envs/draw/pen.py", PEN)
    program = "from arkanoid.envs.draw.pen import thick; report(thick(10.0))"
    cold = scratch.run(program)
    assert sorted(cold.compiled) == ["scaled", "thick"]
    assert len(cold.stderr.splitlines()) == 1
    assert cold.stderr.startswith("arkanoid: compiling kernels of pictures (once")
    assert scratch.run(program).stderr == ""
