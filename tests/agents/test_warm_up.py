"""`arkanoid warm-up`: afterwards nothing waits for the compiler."""

import sys
from pathlib import Path

import pytest
from arkanoid.physics.kernels.numba_internals import is_interpreted
from helpers.processes import ARKANOID, run

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


@pytest.mark.skipif(is_interpreted(), reason="nothing is compiled")
def test_nothing_is_compiled_afterwards(tmp_path: Path) -> None:
    """Each new part made its user wait again: an observation, a picture, the window."""
    changes = {"ARKANOID_CACHE_DIR": str(tmp_path)}
    done = run(*ARKANOID, "warm-up", changes=changes)
    assert done.stdout.splitlines()[0] == "1 of 6: the game"
    assert "all is compiled" in done.stdout
    assert "compiling kernels of pictures (once" in done.stderr
    listening = """
from numba.core import event
compiled = event.RecordingListener()
event.register("numba:compile", compiled)
"""
    told = "print([each.data['dispatcher'].py_func.__name__ for _, each in compiled.buffer])"
    program = tmp_path / "program.py"
    program.write_text(listening + PROGRAM + told)
    after = run(sys.executable, program, changes=changes)
    assert after.stdout.split() == ["[]"]


def test_it_does_not_compile_what_cannot_be_kept(tmp_path: Path) -> None:
    """It compiled for a minute, kept nothing, and ended with "all is compiled"."""
    (tmp_path / "file").touch()
    changes = {"ARKANOID_CACHE_DIR": str(tmp_path / "file")}
    done = run(*ARKANOID, "warm-up", changes=changes, status=2)
    assert done.stdout == ""
    assert "nothing would be kept; set ARKANOID_CACHE_DIR" in done.stderr
