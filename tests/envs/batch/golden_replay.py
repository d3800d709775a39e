"""Records `golden.replay` anew: needed after a change of the rules, together with their version.

Run: python tests/envs/batch/golden_replay.py
"""

from pathlib import Path

import numpy as np
from arkanoid.envs import ArkanoidEnv, Replay

FILE = Path(__file__).with_name("golden.replay")
# Much happens in few decisions: a round with many capsules and enemies, and the boss.
RULES = {
    "levels": ["hourglass", "warden"],
    "lives": 5,
    "capsule_rate": 0.4,
    "sticky_action": 0.05,
    "max_decisions": 3000,
}


def record() -> Replay:
    """Play one game: most of the time after the ball or the capsule, now and then anyhow."""
    env = ArkanoidEnv(**RULES)
    recorder = env.record()
    observation, _ = env.reset(seed=1986)
    layout, luck = env.layout, np.random.default_rng(1986)
    over = False
    while not over:
        part = {name: observation[where] for name, where in layout.items()}
        ball = int(np.where(part["ball_in_play"] > 0, part["ball_y"], 2.0).argmin())
        falls = part["capsule"].any() and part["ball_vy"][ball] > 0
        target = part["capsule_x"][0] if falls else part["ball_x"][ball]
        way = target + 0.05 * luck.normal() - part["paddle"][0]
        move = 0 if abs(way) < 0.05 else 2 if way > 0 else 1
        fire = 3 if luck.random() < 0.5 else 0
        observation, _, terminated, truncated, _ = env.step(move + fire)
        over = terminated or truncated
    return recorder.replay()


if __name__ == "__main__":
    replay = record()
    replay.save(FILE)
    print(f"{FILE.name}: {FILE.stat().st_size} bytes, {replay.result}")
