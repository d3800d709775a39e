"""Games as tensors when something comes between: Ctrl-C, another thread, another form of mask."""

import threading

import numpy as np
import pytest
import torch
from arkanoid.envs.batch.stepping import reset_worlds
from gymnasium.error import ResetNeeded
from helpers.interrupts import interrupted_at
from helpers.tensors import make, same


def begun(count, **keywords):
    """Return a tensor environment that was reset."""
    env = make("cpu", count, **keywords)
    env.reset(seed=0)
    return env


def test_the_first_reset_may_be_partial():
    env = make("cpu", 3)
    with pytest.raises(ResetNeeded, match=r"reset\(\) before the first step\(\): worlds \[0, 1, 2"):
        env.step([0, 0, 0])
    env.reset(seed=0, options={"reset_mask": torch.tensor([True, False, True])})
    with pytest.raises(ResetNeeded, match=r"worlds \[1\]"):
        env.step([0, 0, 0])
    env.reset(options={"reset_mask": np.array([False, True, False])})
    env.step([0, 0, 0])


@pytest.mark.parametrize(
    ("mask", "error", "message"),
    [
        (torch.tensor([1, 0, 1]), TypeError, "must be of bool; got a tensor of torch.int64"),
        (torch.ones(3, dtype=torch.bool, device="meta"), TypeError, "dense tensor .* got meta"),
        (torch.tensor([True]), ValueError, r"must have shape \(3,\)"),
    ],
    ids=str,
)
def test_other_masks_are_refused(mask, error, message):
    env = begun(3)
    before = env.snapshot()
    with pytest.raises(error, match=message):
        env.reset(options={"reset_mask": mask})
    assert env.snapshot() == before


def test_an_interrupted_step_does_no_harm():
    """In same-step mode, an ended episode went on where the next one had not begun."""
    env = begun(3, autoreset_mode="SameStep", max_decisions=1)
    actions = torch.zeros(3, dtype=torch.int64)
    left_over = 0
    for event in range(1, 100):
        if not interrupted_at(event, lambda: env.step(actions)):
            break
        left_over += bool(env.state["done"].any())
        env.step(actions)
        assert not env.state["done"].any()
        assert (env.state["decisions"] == 0).all()
    assert 10 < event < 99
    assert left_over > 0


def test_an_interrupted_reset_does_no_harm():
    """In same-step mode, games that the reset had only given up went on in the next step."""
    env, other = (make(device, 3, autoreset_mode="SameStep") for device in ("cpu", None))
    given_up = 0
    for event in range(1, 300):
        env.reset(seed=0)
        for _ in range(3):
            env.step([1, 2, 0])
        if not interrupted_at(event, lambda: env.reset(seed=5, options={"level": "vault"})):
            break
        over = env.state["done"] != 0
        given_up += bool(over.any())
        seen, _, terminated, truncated, _ = env.step([1, 1, 1])
        assert not (terminated | truncated).any()
        assert (env.state["decisions"][over] == 1).all()
        same(seen, other.restore(env.snapshot())[0])
        same(env.step([2, 2, 2])[0], other.step([2, 2, 2])[0])
    assert 100 < event < 299
    assert given_up > 0


def test_no_other_thread_comes_into_a_reset(monkeypatch):
    """A step of another thread was lost where the processor had the worlds."""
    env = begun(2)
    refused = []

    def step():
        with pytest.raises(RuntimeError, match="one thread at a time") as error:
            env.step([0, 0])
        refused.append(error)

    reset = env._batch.reset

    def slow_reset(*arguments):
        thread = threading.Thread(target=step)
        thread.start()
        thread.join()
        reset(*arguments)

    monkeypatch.setattr(env._batch, "reset", slow_reset)
    env.reset(seed=1)
    assert len(refused) == 1
    env.step([0, 0])


def test_another_thread_is_refused():
    env = begun(2)
    env._tensors.alone.taken = True
    for call in (lambda: env.step([0, 0]), env.reset, lambda: env.restore(b""), lambda: env.state):
        with pytest.raises(RuntimeError, match="one thread at a time"):
            call()


@pytest.mark.parametrize("device", [None, "cpu"])
def test_a_mask_may_be_read_in_any_direction(device):
    """Kernels were compiled once more for it, for a quarter of a minute."""
    env = make(device, 3)
    env.reset(seed=0)
    compiled = len(getattr(reset_worlds, "signatures", ()))
    wide = np.array([True, False, False, False, True])
    env.reset(options={"reset_mask": wide[::2]})
    env.reset(options={"reset_mask": wide[::-2]})
    assert len(getattr(reset_worlds, "signatures", ())) == compiled
