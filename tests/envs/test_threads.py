"""Environments and threads: several at once, closing, forked processes, Ctrl-C in a step."""

import signal
import threading
from contextlib import nullcontext

import arkanoid  # noqa: F401
import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode
from helpers.interrupts import interrupted_at
from helpers.processes import run_program

# Capsules, lost lives and ends of episodes are frequent.
LIVELY = {"capsule_rate": 1.0, "lives": 1, "max_decisions": 40, "levels": "seeds:0-99"}


def threads_of_worlds():
    return [each for each in threading.enumerate() if each.name.startswith("arkanoid")]


def test_closing_again_ends_the_threads_of_a_later_step():
    """Gymnasium closes an environment once: threads of a step after that stayed."""
    before = threads_of_worlds()
    env = ArkanoidVectorEnv(4, threads=2)
    env.reset(seed=0)
    for _ in range(3):
        env.step(np.zeros(4, int))
        assert len(threads_of_worlds()) > len(before)
        env.close()
        assert threads_of_worlds() == before


def test_a_forked_process_steps_with_threads_of_its_own():
    """The child waited forever for threads that only its parent had."""
    run_program(
        """
import multiprocessing
import numpy as np
from arkanoid.physics import Body, Particle, World, WorldBatch
from arkanoid.envs import ArkanoidVectorEnv

env = ArkanoidVectorEnv(8, threads=2)
env.reset(seed=0)
world = World([Body(Particle(1.0), (0.0, 0.0), (1.0, 0.0), mass=1.0)])
batch = WorldBatch(world, 4, threads=2)

def step():
    for _ in range(5):
        observations = env.step(np.full(8, 3))[0]
        batch.step(0.5)
    return observations.tobytes() + batch.positions.tobytes()

def step_and_close(connection):
    connection.send_bytes(step())
    env.close()
    batch.close()

step()
context = multiprocessing.get_context("fork")
theirs, ours = context.Pipe()
child = context.Process(target=step_and_close, args=(ours,))
child.start()
assert theirs.poll(60), "the child does not answer"
assert theirs.recv_bytes() == step()
child.join(60)
assert child.exitcode == 0
env.close()
batch.close()
""",
        warnings="default",
    )


def test_a_process_that_was_forked_during_a_step_may_step():
    """The thread that was in the step is not in the child, which was refused for ever."""
    run_program(
        """
import multiprocessing, sys, threading
import numpy as np
from arkanoid.envs import ArkanoidVectorEnv

class Pause:
    inside, go_on = threading.Event(), threading.Event()

    def step(self):
        self.inside.set()
        self.go_on.wait(60)

def step(env):
    env._batch.listeners.remove(pause)
    env.reset(seed=1)
    for _ in range(3):
        env.step(np.full(8, 3))

env = ArkanoidVectorEnv(8, threads=2)
env.reset(seed=0)
env.step(np.full(8, 3))
pause = Pause()
env._batch.listeners.add(pause)
thread = threading.Thread(target=env.step, args=(np.full(8, 3),))
thread.start()
assert pause.inside.wait(60)
child = multiprocessing.get_context("fork").Process(target=step, args=(env,))
child.start()
child.join(60)
assert child.exitcode == 0
try:
    env.reset()
except RuntimeError:
    pause.go_on.set()
thread.join(60)
step(env)
env.close()
""",
        warnings="default",
    )


@pytest.mark.parametrize("mode", [each.value for each in AutoresetMode])
def test_a_step_goes_on_wherever_ctrl_c_has_come(mode):
    """In same-step mode, a world whose episode was over then went on behind its end."""
    came, event = True, 0
    while came:
        event += 1
        env = ArkanoidVectorEnv(2, autoreset_mode=mode, **LIVELY | {"max_decisions": 5})
        env.reset(seed=event)
        actions = np.full(2, 3)
        for _ in range(4):
            env.step(actions)
        came = interrupted_at(event, lambda env=env, actions=actions: env.step(actions))
        if mode == "Disabled":
            with pytest.raises(ResetNeeded) if (env.state["done"] != 0).any() else nullcontext():
                env.step(actions)
            env.reset()
        observations, rewards, *_ = env.step(actions)
        assert env.observation_space.contains(observations)
        assert np.isfinite(rewards).all()
        assert mode != "SameStep" or not env.state["done"].any()
        env.close()
    assert event > 5


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="there are no timers")
def test_ctrl_c_in_steps_with_threads_hangs_nothing():
    """It came between two steps of a lock of Python's pool, which stayed locked."""
    run_program(
        """
import random, signal, threading, time
import numpy as np
from arkanoid.envs import ArkanoidVectorEnv

def interrupt(number, frame):
    raise KeyboardInterrupt

signal.signal(signal.SIGALRM, interrupt)
env = ArkanoidVectorEnv(256, threads=2)
env.reset(seed=0)
actions = np.full(256, 3)
env.step(actions)
came = 0
end = time.monotonic() + 3.0
while came < 21 or time.monotonic() < end:
    try:
        signal.setitimer(signal.ITIMER_REAL, random.uniform(1e-5, 3e-4))
        env.step(actions)
        signal.setitimer(signal.ITIMER_REAL, 0)
    except KeyboardInterrupt:
        came += 1
        state = env.state.tobytes()
        time.sleep(0.0005)
        assert env.state.tobytes() == state
assert came > 20
steps = []
thread = threading.Thread(target=lambda: steps.append(env.step(actions)))
thread.start()
thread.join(60)
assert len(steps) == 1
env.close()
""",
    )


class Meddler:
    """Calls functions in another thread while a step runs, and keeps the errors."""

    def __init__(self, *calls):
        self.calls = calls
        self.errors = []

    def step(self):
        for call in self.calls:
            thread = threading.Thread(target=self._try, args=(call,))
            thread.start()
            thread.join()

    def _try(self, call):
        try:
            call()
        except RuntimeError as error:
            self.errors.append(str(error))


@pytest.mark.parametrize("count", [None, 2])
def test_a_second_thread_is_refused_while_a_step_runs(count):
    if count is None:
        env, actions = ArkanoidEnv(), 3
    else:
        env, actions = ArkanoidVectorEnv(count), np.full(count, 3)
    env.reset(seed=0)
    snapshot = env.snapshot()
    calls = [
        lambda: env.step(actions),
        env.reset,
        env.snapshot,
        lambda: env.restore(snapshot),
    ]
    if count is not None:
        one = env.snapshot(0)
        calls += [lambda: env.snapshot(0), lambda: env.spread(one), lambda: env.spread(one, seed=1)]
    meddler = Meddler(*calls)
    env._batch.listeners.add(meddler)
    seen = env.step(actions)[0]
    assert len(meddler.errors) == len(calls)
    assert all("one thread at a time" in error for error in meddler.errors)
    env._batch.listeners.remove(meddler)
    env.restore(snapshot)
    assert env.step(actions)[0].tobytes() == seen.tobytes()
