"""Threads that share work: Ctrl-C at any moment leaves them usable, and no array changes behind it.

Each in a process of its own: a thread that hangs must fail the test, not hang it.
"""

import signal

import pytest
from helpers.processes import run_program

PARTS = 3
PROGRAM = f"""
import sys, time
from arkanoid.physics.kernels.threads import Threads

def work(part):
    time.sleep(0.0002)
    part.append(0)
    return len(part)

threads = Threads("worker")
parts = [[] for _ in range({PARTS})]
threads.run(work, parts)
"""


def test_an_exception_at_any_bytecode_leaves_the_threads_usable() -> None:
    """Python's own pool has locks that stayed locked; and tasks went on behind the interruption."""
    run_program(
        f"""{PROGRAM}
def interrupted_at(place):
    def trace(frame, kind, argument):
        nonlocal place
        if not frame.f_code.co_filename.endswith("threads.py"):
            return None
        frame.f_trace_opcodes = True
        if kind == "opcode":
            place -= 1
            if place == 0:
                raise KeyboardInterrupt
        return trace

    sys.settrace(trace)
    try:
        threads.run(work, parts)
    except KeyboardInterrupt:
        return True
    finally:
        sys.settrace(None)
    return False

place = 1
while interrupted_at(place):
    lengths = [len(part) for part in parts]
    time.sleep(0.001)
    assert lengths == [len(part) for part in parts], place
    assert threads.run(work, parts) == [length + 1 for length in lengths], place
    place += 1
assert place > 100
threads.close()
""",
    )


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="there are no timers")
def test_ctrl_c_again_and_again_hangs_nothing() -> None:
    """A second Ctrl-C ended the wait for the threads; a lock that was lost hung the next run."""
    run_program(
        f"""{PROGRAM}
import random, signal

left = 0
def interrupt(number, frame):
    global left
    if left > 0:
        left -= 1
        raise KeyboardInterrupt

signal.signal(signal.SIGALRM, interrupt)
came = 0
end = time.monotonic() + 3.0
while came < 21 or time.monotonic() < end:
    try:
        left = random.choice([1, 1, 2])
        signal.setitimer(signal.ITIMER_REAL, random.uniform(1e-5, 8e-4), 1e-4)
        threads.run(work, parts)
        left = 0
    except KeyboardInterrupt:
        left = 0
        came += 1
        lengths = [len(part) for part in parts]
        time.sleep(0.001)
        assert lengths == [len(part) for part in parts]
signal.setitimer(signal.ITIMER_REAL, 0)
assert came > 20
lengths = [len(part) for part in parts]
assert threads.run(work, parts) == [length + 1 for length in lengths]
threads.close()
""",
    )


def test_an_error_in_a_thread_reaches_the_caller_when_all_have_finished() -> None:
    run_program(
        f"""{PROGRAM}
def fail(part):
    if part is parts[1]:
        raise ValueError("the second")
    return work(part)

for _ in range(20):
    before = len(parts[2])
    try:
        threads.run(fail, parts)
    except ValueError as error:
        assert str(error) == "the second"
    else:
        raise AssertionError
    assert len(parts[2]) == before + 1
assert len(parts[1]) == 1
threads.close()
""",
    )


def test_threads_end_when_nobody_keeps_them() -> None:
    run_program(
        f"""{PROGRAM}
import threading
workers = [each for each in threading.enumerate() if each.name == "worker"]
assert len(workers) == {PARTS - 1}
del threads
for worker in workers:
    worker.join(60)
    assert not worker.is_alive()
""",
    )
