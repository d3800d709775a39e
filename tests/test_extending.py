"""What `docs/extending.md` tells to change, done to a copy of the sources, works as it says."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGE = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
PACKAGES = ("configs", "envs", "physics")

REWARD = """
import gymnasium as gym

env = gym.make("arkanoid:Arkanoid-v0", reward="bricks")
env.reset(seed=0)
total = 0
for _ in range(1000):
    _, reward, terminated, truncated, info = env.step(env.action_space.sample())
    assert reward == info["bricks_broken"]
    total += reward
    if terminated or truncated:
        env.reset()
assert total > 0
"""

CAPSULE = """
import math
from arkanoid.envs import ArkanoidEnv
from arkanoid.envs.capsules import capsule_by_weight
from arkanoid.envs.grid import STATUS
from arkanoid.envs.palette import CAPSULE, PALETTE
from arkanoid.envs.rules import CAPSULES, FAST, PADDLE_TOP

env = ArkanoidEnv(frame_skip=1)
env.reset(seed=0)
env.step(3)  # serve
world = env._batch.worlds[0]
slow = math.hypot(world.ball_vx[0], world.ball_vy[0])
world.capsule, world.capsule_x, world.capsule_y = FAST, world.paddle_x, PADDLE_TOP + 1.0
observation, *_ = env.step(0)
shown = observation[env.layout["capsule"]]
assert len(shown) == CAPSULES == 8 and shown[7] == 1.0 and shown.sum() == 1.0
while world.capsule == FAST:
    env.step(0)
assert world.capsules_caught == 1 and world.speed_stage == 2
fast = math.hypot(world.ball_vx[0], world.ball_vy[0])
assert abs(fast / slow - 1.5) < 1e-12, fast / slow
assert tuple(PALETTE[CAPSULE + FAST]) == (255, 236, 120)
assert "capsule_fast" in STATUS and len(set(STATUS.values())) == len(STATUS)

drawn = [capsule_by_weight((place + 0.5) / 65536) for place in range(65536)]
share = 250 / 256 / 16
assert abs(drawn.count(FAST) / 65536 - share) < 1e-4
assert sorted(set(drawn)) == list(range(1, 9))
"""


def changes(page: str) -> list[tuple[str, str, str]]:
    """Return (file, the lines as they are, the lines as they are to be) of each block."""
    found = []
    for file, block in re.findall(r"^```diff\n--- (\S+)\n(.*?)^```$", page, flags=re.M | re.S):
        lines = block.splitlines(keepends=True)
        old = "".join(line[1:] for line in lines if line[0] != "+")
        new = "".join(line[1:] for line in lines if line[0] != "-")
        found.append((file, old, new))
    return found


@pytest.fixture(scope="module")
def changed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder in which `arkanoid` is a copy with all changes of the page."""
    folder = tmp_path_factory.mktemp("changed")
    copy = folder / "arkanoid"
    for package in PACKAGES:
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / package, copy / package, ignore=ignored)
    for file in ROOT.glob("*.py"):
        shutil.copy(file, copy)
    for file, old, new in changes(PAGE):
        text = (copy / file).read_text(encoding="utf-8")
        assert text.count(old) == 1, f"{file} does not have once:\n{old}"
        (copy / file).write_text(text.replace(old, new), encoding="utf-8")
    return folder


def test_a_block_is_what_was_and_what_is_to_be() -> None:
    page = "Text\n```diff\n--- envs/a.py\n one\n-two\n+three\n+four\n five\n```\n"
    assert changes(page) == [("envs/a.py", "one\ntwo\nfive\n", "one\nthree\nfour\nfive\n")]


def test_the_page_has_all_of_its_changes() -> None:
    assert len(changes(PAGE)) == PAGE.count("```diff")


@pytest.mark.parametrize("program", [REWARD, CAPSULE], ids=["reward", "capsule"])
def test_what_was_added_works(program: str, changed: Path) -> None:
    environment = {
        **os.environ,
        "PYTHONPATH": str(changed),
        "ARKANOID_CACHE_DIR": str(changed / "cache"),
    }
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        cwd=changed,
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr


def test_what_was_changed_is_in_format(changed: Path) -> None:
    """A recipe that leaves a line too long would be refused by `make check`."""
    files = sorted({str(changed / "arkanoid" / file) for file, *_ in changes(PAGE)})
    settings = ["--config", str(ROOT / "pyproject.toml")]
    for command in (["check"], ["format", "--check"]):
        done = subprocess.run(
            [sys.executable, "-m", "ruff", *command, *settings, *files],
            cwd=ROOT,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stdout
