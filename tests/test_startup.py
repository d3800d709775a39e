"""A program that starts a second time does not wait for the compiler."""

import json

from helpers.processes import run_program

PROGRAM = """
import json, sys
from numba.core import event
recorder = event.RecordingListener()
event.register("numba:compile", recorder)

import gymnasium as gym
env = gym.make("arkanoid:Arkanoid-v0", render_mode="rgb_array")
env.reset(seed=0)
env.step(env.action_space.sample())
env.render()
env.close()

for mode in ("NextStep", "SameStep", "Disabled"):
    envs = gym.make_vec("Arkanoid-v0", 4, "vector_entry_point", autoreset_mode=mode)
    envs.reset(seed=0)
    envs.step(envs.action_space.sample())
    envs.close()

print(json.dumps([str(e.data["dispatcher"].py_func) for _, e in recorder.buffer if e.is_start]))
print(json.dumps(sorted(sys.modules)))
"""
# What Numba loads before it compiles, SciPy included; and what only users of the engine need.
NEEDLESS = {"numba.np.arraymath", "numba.np.linalg", "scipy.linalg", "arkanoid.physics.world"}


def start() -> list[list[str]]:
    """Return the names of the functions that the program compiles, and of modules it imports."""
    return [json.loads(line) for line in run_program(PROGRAM).stdout.splitlines()]


def test_a_second_start_compiles_nothing() -> None:
    """Numba can cache every kernel, too: otherwise it warns, and a warning is an error."""
    start()
    compiled, imported = start()
    assert compiled == []
    assert NEEDLESS.isdisjoint(imported)
