"""The disk cache: it is used, shared, repaired and pruned, and programs run without it."""

import os
import shutil
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from helpers.scratch_package import CALL, Scratch

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


def test_second_process_loads_without_compiling(scratch: Scratch) -> None:
    cold = scratch.run()
    warm = scratch.run()
    assert cold.result == warm.result == 21.0
    assert sorted(cold.compiled) == ["scaled", "shifted"]
    assert warm.compiled == []


@pytest.mark.parametrize("place", ["below a file", "full"])
def test_programs_run_without_a_cache(scratch: Scratch, place: str) -> None:
    """An unwritable home or a full disk makes a program slower, and does not end it.

    Numba itself would fall back to ``__pycache__``, and with it to stale machine code. (Tests may
    run as root, who may write everywhere: therefore a file is in the way.)
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


def test_a_filled_folder_need_not_be_written(scratch: Scratch) -> None:
    """Code in a container image was not read by a user who may not write there.

    Every process compiled again. (Root may write everywhere: therefore the calls are replaced.)
    """
    scratch.run()
    refusing = """
import os, tempfile
def refuse(*arguments, **keywords):
    raise PermissionError(13, "Permission denied")
os.utime = tempfile.TemporaryFile = refuse
"""
    warm = scratch.run(refusing + CALL)
    assert warm.result == 21.0
    assert warm.compiled == []
    assert "ARKANOID_CACHE_DIR" not in warm.stderr


@pytest.mark.parametrize("variable", ["", "~/cache"])
def test_programs_run_for_a_user_without_a_home(scratch: Scratch, variable: str) -> None:
    """In a container with an unknown user, `import arkanoid.physics` raised an error.

    The program makes the user database empty. With ``~/cache``, there was a folder named "~".
    """
    outcome = scratch.run(NOBODY + CALL, ARKANOID_CACHE_DIR=variable)
    assert outcome.result == 21.0
    assert sum("ARKANOID_CACHE_DIR" in line for line in outcome.stderr.splitlines()) == 1
    assert not list(scratch.code.rglob("*.nb[ci]"))


def test_a_tilde_is_the_home(scratch: Scratch) -> None:
    """In a settings file, no shell replaces ``~`` by the home."""
    home = str(scratch.code.parent)
    scratch.run(ARKANOID_CACHE_DIR="~/cache", HOME=home, USERPROFILE=home)
    assert scratch.folders()
    assert not (scratch.code / "~").exists()


def replace_by_a_folder(file: Path) -> None:
    file.unlink()
    file.mkdir()
    (file / "something").write_text("in the way")


@pytest.mark.parametrize(
    "damage",
    [
        lambda file: file.write_bytes(b""),
        lambda file: file.write_bytes(file.read_bytes()[:40]),
        lambda file: file.write_bytes(file.read_bytes()[:-1]),
        lambda file: file.write_bytes(file.read_bytes() + b"more"),
        lambda file: file.write_bytes(bytes(file.stat().st_size)),
        replace_by_a_folder,
    ],
    ids=["empty", "first 40 bytes", "all but one byte", "too long", "zeros", "folder"],
)
def test_heals_a_damaged_file(scratch: Scratch, damage: Callable[[Path], None]) -> None:
    """After a power failure a file may be empty, and every start ended in an EOFError."""
    scratch.run()
    assert len(scratch.files()) == 1
    for file in scratch.files():
        damage(file)
    hurt = scratch.run()
    assert (hurt.result, sorted(hurt.compiled)) == (21.0, ["scaled", "shifted"])
    assert scratch.run().compiled == []
    assert len(scratch.files()) == 1


def test_a_flipped_bit_is_noticed(scratch: Scratch) -> None:
    """Most of them ended every later start in some exception, and some in a crash.

    Each turn flips one bit in every file, and the program heals the files for the next turn. All
    bits of a file are flipped in `test_code_files.py`, without a program.
    """
    scratch.run()
    header = range(0, 24, 6)
    for turn in (0, 3, 4, 9, 15):
        for file in scratch.files():
            content = bytearray(file.read_bytes())
            place = header[turn] if turn < 4 else (turn - 3) * (len(content) - 1) // 12
            content[place] ^= 1 << turn % 8
            file.write_bytes(content)
        hurt = scratch.run()
        assert (hurt.result, sorted(hurt.compiled)) == (21.0, ["scaled", "shifted"])
    assert scratch.run().compiled == []


def test_processes_may_compile_at_the_same_time(scratch: Scratch) -> None:
    with ThreadPoolExecutor() as pool:
        outcomes = list(pool.map(lambda _: scratch.run(), range(4)))
    assert [outcome.result for outcome in outcomes] == [21.0] * 4
    warm = scratch.run()
    assert (warm.result, warm.compiled) == (21.0, [])


def test_two_signatures_never_share_a_file(scratch: Scratch) -> None:
    """Two processes compiled two signatures of one kernel at once, and one ran the other's code.

    Numba calls the first data file of each process ``...1.nbc``, and one process's index then named
    the other's machine code. Here the two do not see each other's cache, as at that moment.
    """
    call = "from arkanoid.physics.callee import scaled; report(scaled({}))"
    scratch.run(call.format("10.0"))
    of_floats = [file.name for file in scratch.files()]
    shutil.rmtree(scratch.cache)
    scratch.run(call.format("10"))
    of_integers = [file.name for file in scratch.files()]
    assert len(of_floats) == len(of_integers) == 1
    assert of_floats != of_integers


def test_unused_folders_are_pruned(scratch: Scratch) -> None:
    """Every edit of a kernel makes new folders; unused ones are deleted after 30 days."""
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
