"""Memory that is asked for early: nothing but the time changes."""

import numpy as np
from arkanoid.physics.kernels import is_interpreted, kernel
from arkanoid.physics.kernels.prefetch import prefetch
from helpers.processes import INTERPRETED, run_program

SIZE = 200  # bytes


@kernel
def total_of(rows, ahead):
    """Return the sum of all numbers, and ask for rows further on."""
    total = 0
    for index in range(rows.shape[0]):
        prefetch(rows, index + ahead, 8, SIZE)
        for column in range(rows.shape[1]):
            total += rows[index, column]
    return total


def test_it_changes_nothing_and_may_ask_for_what_lies_beyond_the_end():
    rows = np.arange(50 * 32).reshape(50, 32)
    before = rows.copy()
    for ahead in (0, 1, 50, 10**9):
        assert total_of(rows, ahead) == before.sum()
    assert (rows == before).all()
    # Views have their own distance from row to row.
    assert total_of(rows[::-1, ::2], 1) == before[:, ::2].sum()


def test_it_becomes_one_instruction_per_line_of_the_cache(monkeypatch, tmp_path):
    """It failed in the second run: what an earlier one has kept on disk cannot be looked into."""
    if is_interpreted():
        return
    monkeypatch.setenv("ARKANOID_CACHE_DIR", str(tmp_path))
    compiled = kernel(total_of.py_func)
    compiled(np.zeros((3, 32), np.int64), 1)
    code = "".join(compiled.inspect_llvm().values())
    calls = [line for line in code.splitlines() if "call void @llvm.prefetch" in line]
    lines = SIZE // 64 + 2  # the part may begin and end within a line
    # The compiler may repeat the loop's body.
    assert len(calls) > 0
    assert len(calls) % lines == 0


def test_interpreted_it_does_nothing():
    program = """
import numpy as np
from arkanoid.physics.kernels.prefetch import prefetch
prefetch(np.zeros((2, 2)), 5, 0, 16)
"""
    run_program(program, changes=INTERPRETED)
