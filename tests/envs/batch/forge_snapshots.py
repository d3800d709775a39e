"""Restores forged snapshots of environments, and plays on where they are accepted.

Run: NUMBA_BOUNDSCHECK=1 python tests/envs/batch/forge_snapshots.py COUNT SEED
It prints how many were refused and accepted. It fails if an accepted one leaves the spaces, or if
anything but a ValueError is raised; the caller sees crashes and hangs.
"""

import faulthandler
import sys
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2]))

from arkanoid.envs import ArkanoidVectorEnv
from arkanoid.envs.ranges import OUTCOME_RANGES, WORLD_RANGES
from arkanoid.envs.state import Outcome, World
from helpers.forging import forge, opened, sealed_again

WORLDS = 4
SECONDS = 60  # in which one of them is played, or it hangs
LIVELY: dict[str, Any] = {"capsule_rate": 1.0, "lives": 2, "max_decisions": 200}
SETUPS: list[dict[str, Any]] = [
    {"levels": ["warden", "ripple"]} | LIVELY,
    {"observation": "grid", "levels": ["spiral", "warden"], "episodic_life": True} | LIVELY,
    {"observation": "rgb", "size": 24, "grey": True, "stack": 3} | LIVELY,
    {"observation": "rgb", "size": (40, 33), "levels": ["warden"]} | LIVELY,
    {"observation": "dict", "size": 20, "levels": "train", "reward": "score"} | LIVELY,
    {"capsules": False, "enemies": False, "actions": "discrete3", "deflection": "zones6"},
    {"actions": "box", "deflection": "physical", "paddle": 1.5, "speed": 3.0} | LIVELY,
    {"sticky_action": 0.3, "frame_skip": 1, "reward": "sparse", "speed": 0.5} | LIVELY,
]


def play(env: Any, steps: int) -> None:
    """Play at random, and assert that nothing leaves its space."""
    for _ in range(steps):
        observations, rewards, _, _, infos = env.step(env.action_space.sample())
        assert env.observation_space.contains(observations), observations
        assert np.isfinite(rewards).all()
        assert all((infos[key] >= 0).all() for key in infos)


def taken(env: Any, rng: np.random.Generator, count: int) -> list[bytes]:
    """Return snapshots of different games; each can be restored."""
    env.reset(seed=int(rng.integers(1 << 30)))
    snapshots = []
    for _ in range(count):
        play(env, int(rng.integers(1, 60)))
        snapshots.append(env.snapshot())
        env.restore(snapshots[-1])
    return snapshots


def forged(env: Any, rng: np.random.Generator, snapshot: bytes) -> tuple[bytes, list[str]]:
    """Return a snapshot with some other numbers, and the names of the fields."""
    content = opened(snapshot)
    sizes = [WORLDS * dtype.itemsize for dtype in (World, Outcome)]
    seen = env._batch.observations.nbytes
    first = len(content) - seen - sum(sizes)
    worlds = np.frombuffer(content, World, WORLDS, first)
    outcomes = np.frombuffer(content, Outcome, WORLDS, first + sizes[0])
    names = []
    for _ in range(int(rng.choice([1, 1, 2, 3, 6]))):
        way = rng.random()
        if way < 0.9:
            names.append(forge(rng, worlds, WORLD_RANGES))
        elif way < 0.95:
            names.append(forge(rng, outcomes, OUTCOME_RANGES))
        else:
            # Any byte of the observations, or of all.
            place = int(
                rng.integers(len(content) - seen if rng.random() < 0.8 else 0, len(content))
            )
            content[place] = int(rng.integers(256))
            names.append(f"byte {place}")
    return sealed_again(snapshot, content), names


def main() -> None:
    """Forge so many snapshots."""
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    rng = np.random.default_rng(seed)
    refused = accepted = 0
    for setup in SETUPS:
        env = ArkanoidVectorEnv(WORLDS, **setup)
        env.action_space.seed(int(rng.integers(1 << 30)))
        snapshots = taken(env, rng, 40)
        for _ in range(count // len(SETUPS)):
            faulthandler.dump_traceback_later(SECONDS, exit=True)
            snapshot, names = forged(env, rng, snapshots[rng.integers(len(snapshots))])
            before = env.snapshot()
            try:
                observations, _ = env.restore(snapshot)
            except ValueError:
                refused += 1
                assert env.snapshot() == before
                continue
            accepted += 1
            try:
                assert env.observation_space.contains(observations)
                play(env, 25)
                # What play leads to is legal again.
                env.restore(env.snapshot())
            except BaseException:
                print(f"{setup}: {names}", flush=True)
                raise
        # What is made next may have to be compiled, for longer than that.
        faulthandler.cancel_dump_traceback_later()
    print(f"{refused} refused, {accepted} accepted")


if __name__ == "__main__":
    main()
