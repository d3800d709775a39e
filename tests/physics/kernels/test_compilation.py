"""The kernel decorator, in processes and caches of its own.

A scratch package holds the real folder ``kernels`` and a few tiny kernels, so that tests may edit
them. Every case runs in a fresh process, as a user's would.
"""

import json
import os
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import arkanoid
import numpy as np
import pytest
from arkanoid.physics import kernels
from numba.core.errors import NumbaError

FILES = {
    "arkanoid/__init__.py": "",
    "arkanoid/physics/__init__.py": "",
    "arkanoid/physics/numbers.py": "FACTOR = 2.0\n",
    "arkanoid/physics/callee.py": """
from .kernels import kernel
from .numbers import FACTOR

@kernel
def scaled(x):
    return x * FACTOR
""",
    "arkanoid/envs/__init__.py": "",
    "arkanoid/envs/caller.py": """
from ..physics.callee import scaled
from ..physics.kernels import kernel

@kernel
def shifted(x):
    return scaled(x) + 1.0
""",
    "user.py": """
from arkanoid.physics.callee import scaled
from arkanoid.physics.kernels import kernel

@kernel
def shifted(x):
    return scaled(x) + 1.0
""",
}

PRELUDE = """
import json
from numba.core import event
recorder = event.RecordingListener()
event.register("numba:compile", recorder)
def report(result):
    compiled = [e.data["dispatcher"].py_func.__name__ for _, e in recorder.buffer if e.is_start]
    print(json.dumps([result, compiled]))
"""
NOBODY = """
import os
for name in ("HOME", "USERPROFILE", "HOMEPATH", "HOMEDRIVE", "XDG_CACHE_HOME", "LOCALAPPDATA"):
    os.environ.pop(name, None)
try:
    import pwd
except ModuleNotFoundError:
    pass
else:
    def getpwuid(uid):
        raise KeyError(uid)
    pwd.getpwuid = getpwuid
"""
CALL = "from arkanoid.envs.caller import shifted; report(shifted(10.0))"


@dataclass(frozen=True)
class Outcome:
    result: float
    compiled: list[str]
    stderr: str


class Scratch:
    """A scratch package in ``folder / "code"`` and its cache in ``folder / "cache"``."""

    def __init__(self, folder: Path) -> None:
        self.code = folder / "code"
        self.cache = folder / "cache"
        for name, text in FILES.items():
            self.write(name, text)
        original = Path(arkanoid.__file__).parent / "physics" / "kernels"
        shutil.copytree(
            original,
            self.code / "arkanoid" / "physics" / "kernels",
            ignore=shutil.ignore_patterns("__pycache__"),
        )

    def write(self, name: str, text: str) -> None:
        file = self.code / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def replace(self, name: str, old: str, new: str) -> None:
        text = (self.code / name).read_text(encoding="utf-8")
        assert old in text
        self.write(name, text.replace(old, new))

    def run(self, program: str = CALL, **environment: str) -> Outcome:
        """Run a program in a new process; it ends with a call of ``report(result)``."""
        settings = {
            "PYTHONPATH": str(self.code),
            "ARKANOID_CACHE_DIR": str(self.cache),
            "NUMBA_DISABLE_JIT": "0",
        }
        done = subprocess.run(
            [sys.executable, "-c", PRELUDE + program],
            cwd=self.code,
            env={**os.environ, **settings, **environment},
            capture_output=True,
            text=True,
            timeout=120,
        )
        assert done.returncode == 0, done.stderr
        return Outcome(*json.loads(done.stdout), done.stderr)

    def folders(self) -> list[Path]:
        return sorted((self.cache / "kernels").iterdir())

    def data_files(self) -> set[str]:
        return {file.name for file in self.cache.rglob("*.nbc")}


@pytest.fixture
def scratch(tmp_path: Path) -> Scratch:
    return Scratch(tmp_path)


def test_second_process_loads_without_compiling(scratch: Scratch) -> None:
    cold = scratch.run()
    warm = scratch.run()
    assert cold.result == warm.result == 21.0
    assert sorted(cold.compiled) == ["scaled", "shifted"]
    assert warm.compiled == []


def test_wait_is_announced_once(scratch: Scratch) -> None:
    cold = scratch.run()
    assert len(cold.stderr.splitlines()) == 1
    assert cold.stderr.startswith("arkanoid: compiling kernels")
    assert scratch.run().stderr == ""


def test_caller_sees_an_edited_callee(scratch: Scratch) -> None:
    """Numba's own cache looks at the caller's file only and kept running the old callee."""
    assert scratch.run().result == 21.0
    scratch.replace("arkanoid/physics/callee.py", "x * FACTOR", "x * FACTOR + 100.0")
    assert scratch.run().result == 121.0


def test_caller_sees_an_edited_constant(scratch: Scratch) -> None:
    """As above, two files away: what a kernel reads is frozen into the machine code."""
    assert scratch.run().result == 21.0
    scratch.replace("arkanoid/physics/numbers.py", "2.0", "3.0")
    assert scratch.run().result == 31.0


def test_caller_outside_of_the_package_sees_an_edited_callee(scratch: Scratch) -> None:
    call = "from user import shifted; report(shifted(10.0))"
    assert scratch.run(call).result == 21.0
    assert scratch.run(call).compiled == []
    scratch.replace("arkanoid/physics/numbers.py", "2.0", "3.0")
    assert scratch.run(call).result == 31.0


@pytest.mark.parametrize(
    ("statement", "call"),
    [
        ("from .. import physics", "physics.extra.FACTOR"),
        ("from ..physics import extra", "extra.FACTOR"),
        ("from ..physics import extra as other", "other.FACTOR"),
        ("from ..physics import (  # one (of two)\n    extra,\n)", "extra.FACTOR"),
    ],
)
def test_every_form_of_import_is_followed(scratch: Scratch, statement: str, call: str) -> None:
    scratch.write("arkanoid/physics/__init__.py", "from . import extra\n")
    scratch.write("arkanoid/physics/extra.py", "FACTOR = 5.0\n")
    scratch.replace("arkanoid/envs/caller.py", "from ..physics.callee", f"{statement}\n#")
    scratch.replace("arkanoid/envs/caller.py", "scaled(x)", f"x * {call}")
    assert scratch.run().result == 51.0
    scratch.replace("arkanoid/physics/extra.py", "5.0", "6.0")
    assert scratch.run().result == 61.0


def test_edit_during_a_start_is_not_lost(scratch: Scratch) -> None:
    """A source was saved just after a process had imported it, and before its digest was taken.

    The old machine code then lay in the new digest's folder, and every later process ran it.
    """
    during = scratch.run("""
import pathlib, time
from arkanoid.physics import callee
time.sleep(0.1)  # the clock of files is coarse
file = pathlib.Path(callee.__file__)
file.write_text(file.read_text().replace("x * FACTOR", "x * FACTOR + 100.0"))
from arkanoid.envs.caller import shifted
report(shifted(10.0))
""")
    assert during.result == 21.0
    assert scratch.run().result == 121.0


def test_edit_recompiles_only_what_can_depend_on_it(scratch: Scratch) -> None:
    scratch.run()
    scratch.replace("arkanoid/envs/caller.py", "1.0", "2.0")
    # The callee's signature is asked for by the compiler, and found in the cache.
    assert scratch.run().compiled == ["shifted"]


def test_debugging_does_not_run_code_compiled_without(scratch: Scratch) -> None:
    """Bounds checks found nothing: the machine code came from the cache and had none."""
    scratch.run()
    assert scratch.run(NUMBA_BOUNDSCHECK="1").compiled != []
    assert scratch.run().compiled == []


@pytest.mark.parametrize("place", ["below a file", "full"])
def test_goes_on_without_a_cache(scratch: Scratch, place: str) -> None:
    """An unwritable home or a full disk costs time, not the program.

    Where its folder cannot be written Numba falls back to ``__pycache__``, and with it to stale
    machine code. (Tests may run as root, who may write everywhere: hence a file in the way.)
    """
    program = CALL
    if place == "below a file":
        scratch.cache.write_text("in the way")
    else:
        program = """
import pathlib, shutil
from arkanoid.envs.caller import shifted
kernels = pathlib.Path(__import__("os").environ["ARKANOID_CACHE_DIR"]) / "kernels"
shutil.rmtree(kernels)
kernels.write_text("in the way")
report(shifted(10.0))
"""
    outcome = scratch.run(program)
    assert outcome.result == 21.0
    assert sum("ARKANOID_CACHE_DIR" in line for line in outcome.stderr.splitlines()) == 1
    assert not list(scratch.code.rglob("*.nb[ci]"))


@pytest.mark.parametrize("variable", ["", "~/cache"])
def test_goes_on_for_a_user_without_a_home(scratch: Scratch, variable: str) -> None:
    """As in a container that runs under any number: `import arkanoid.physics` raised an error.

    Who is asked where the home is, is made to know nobody; ``~/cache`` became a folder named "~".
    """
    outcome = scratch.run(NOBODY + CALL, ARKANOID_CACHE_DIR=variable)
    assert outcome.result == 21.0
    assert sum("ARKANOID_CACHE_DIR" in line for line in outcome.stderr.splitlines()) == 1
    assert not list(scratch.code.rglob("*.nb[ci]"))


def test_home_may_be_named_by_its_sign(scratch: Scratch) -> None:
    """In a file of settings or a container's, no shell puts the home in place of ``~``."""
    home = str(scratch.code.parent)
    scratch.run(ARKANOID_CACHE_DIR="~/cache", HOME=home, USERPROFILE=home)
    assert scratch.folders()
    assert not (scratch.code / "~").exists()


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
@pytest.mark.parametrize("size", [0, 40])
def test_heals_a_file_cut_short(scratch: Scratch, suffix: str, size: int) -> None:
    """After a power failure Numba's index may be empty, and every start ended in an EOFError."""
    scratch.run()
    for file in scratch.cache.rglob(f"*.{suffix}"):
        file.write_bytes(file.read_bytes()[:size])
    assert scratch.run().result == 21.0
    assert scratch.run().compiled == []


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


def test_second_import_under_another_name_compiles_nothing(scratch: Scratch) -> None:
    """The root is the package: tools may import it under the name of the folder, too."""
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


def test_constants_do_not_compile_a_kernel_anew(scratch: Scratch) -> None:
    """Numba compiled `impact_between` and all below it for each pair of the game's shapes.

    It makes a signature of every constant that is passed: with a dozen shapes by their numbers, the
    first step took a minute.
    """
    scratch.write(
        "constants.py",
        """
from arkanoid.physics.kernels.decorators import inlined, kernel

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
        "from constants import power, total; report([total(3), len(power.signatures)])"
    )
    assert run.result == [3 + 4 + 27 + 27, 1]
    assert sorted(run.compiled) == ["power", "total"]


def test_an_inner_kernel_serves_kernels_and_refuses_python(scratch: Scratch) -> None:
    """It has no way in from Python: Numba would call a null pointer."""
    scratch.write(
        "inside.py",
        """
from arkanoid.physics.kernels.decorators import inner, kernel

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


def test_processes_may_compile_at_the_same_time(scratch: Scratch) -> None:
    with ThreadPoolExecutor() as pool:
        outcomes = list(pool.map(lambda _: scratch.run(), range(4)))
    assert [outcome.result for outcome in outcomes] == [21.0] * 4
    warm = scratch.run()
    assert (warm.result, warm.compiled) == (21.0, [])


def test_two_signatures_never_share_a_file(scratch: Scratch) -> None:
    """Two processes compiled two signatures of one kernel at once, and one ran the other's code.

    Numba calls the first data file of each process ``...1.nbc``; the index of the one then named
    the machine code of the other. Here the two do not see each other's cache, as in that moment.
    """
    call = "from arkanoid.physics.callee import scaled; report(scaled({}))"
    scratch.run(call.format("10.0"))
    of_floats = scratch.data_files()
    shutil.rmtree(scratch.cache)
    scratch.run(call.format("10"))
    assert len(of_floats) == 1
    assert len(scratch.data_files()) == 1
    assert not of_floats & scratch.data_files()


def test_unused_folders_are_pruned(scratch: Scratch) -> None:
    """Every edit of a kernel begins new folders; those of earlier sources go after 30 days."""
    scratch.run()
    before = scratch.folders()
    assert len(before) == 2  # the callee's and the caller's
    foreign = scratch.cache / "kernels" / "notes"
    foreign.mkdir()
    long_ago = time.time() - 31 * 86_400
    for folder in (before[0], foreign):
        os.utime(folder, (long_ago, long_ago))

    scratch.replace("arkanoid/physics/callee.py", "x * FACTOR", "x * FACTOR + 100.0")
    scratch.run()
    left = scratch.folders()
    assert before[0] not in left
    assert before[1] in left
    assert foreign in left
    assert len(left) == 4


def test_use_keeps_a_folder_from_being_pruned(scratch: Scratch) -> None:
    scratch.run()
    long_ago = time.time() - 31 * 86_400
    for folder in scratch.folders():
        os.utime(folder, (long_ago, long_ago))
    assert scratch.run().compiled == []
    assert all(time.time() - folder.stat().st_mtime < 86_400 for folder in scratch.folders())


def test_a_kernel_that_allocates_does_not_compile() -> None:
    """Nor does one that returns an array; an accessor may. So a step costs no reference counts."""

    def allocates(size: int) -> float:
        return float(np.zeros(size)[0])

    def looks(values: Any) -> Any:
        return values[1:]

    with pytest.raises(NumbaError):
        kernels.kernel(allocates)(3)
    with pytest.raises(NumbaError):
        kernels.kernel(looks)(np.arange(3.0))
    assert kernels.accessor(looks)(np.arange(3.0)).tolist() == [1, 2]
