"""`arkanoid warm-up`: afterwards nothing waits for the compiler."""

from pathlib import Path

import pytest
from arkanoid.physics.kernels.numba_internals import is_interpreted
from helpers.processes import ARKANOID, run, run_program

WARM_UP = """
from arkanoid.agents.cli import main

assert main(["warm-up"]) == 0
"""
# What users do first, each part of it with kernels of its own.
PROGRAM = """
import arkanoid
import gymnasium as gym
from arkanoid.envs.draw.overlay import draw_overlay
from arkanoid.envs.levels import generate_level
from arkanoid.envs.registration import GAMES

def play(env):
    env.reset(seed=0)
    env.step(env.action_space.sample())
    return env.unwrapped

for name in GAMES:
    draw_overlay(play(gym.make(name, render_mode="rgb_array")).render(), "GAME OVER", ["AGAIN?"])
    play(gym.make_vec(name, num_envs=3))
for keywords in (
    {"observation": "grid"}, {"observation": "dict"}, {"landing": True}, {"episodic_life": True},
    {"observation": "rgb", "size": (100, 80), "channels": "last"}, {"difficulty": 0.7},
):
    play(gym.make("Arkanoid-v0", **keywords))
env = play(gym.make("Arkanoid-v0"))
env.action_masks()
env.restore(env.snapshot())
generate_level(3)
"""
# Tells which kernels that Python calls have machine code, and for which types.
TELLING = """
import gc
from arkanoid.physics.kernels.callees import RootDispatcher

for one in gc.get_objects():
    if isinstance(one, RootDispatcher):
        for types in one.signatures:
            print("kernel", one.py_func.__module__, one.py_func.__qualname__, types)
"""


def kernels(said: str) -> set[str]:
    return {line for line in said.splitlines() if line.startswith("kernel ")}


@pytest.mark.skipif(is_interpreted(), reason="nothing is compiled")
def test_nothing_is_compiled_afterwards() -> None:
    """Each new part made its user wait again: an observation, a picture, the window.

    Machine code of other tests may be in the cache; so what both programs have is compared.
    """
    warm_up = run_program(WARM_UP + TELLING).stdout
    assert warm_up.splitlines()[0] == "1 of 6: the game"
    assert "all is compiled" in warm_up
    needed = kernels(run_program(PROGRAM + TELLING).stdout)
    assert len(needed) > 15
    assert needed - kernels(warm_up) == set()


def test_it_does_not_compile_what_cannot_be_kept(tmp_path: Path) -> None:
    """It compiled for a minute, kept nothing, and ended with "all is compiled"."""
    (tmp_path / "file").touch()
    changes = {"ARKANOID_CACHE_DIR": str(tmp_path / "file")}
    done = run(*ARKANOID, "warm-up", changes=changes, status=2)
    assert done.stdout == ""
    assert "nothing would be kept; set ARKANOID_CACHE_DIR" in done.stderr
