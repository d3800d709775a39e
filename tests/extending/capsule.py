"""With the changes of `docs/extending.md`: a capsule that makes the ball faster."""

import math

import numpy as np
from arkanoid.envs import ArkanoidEnv
from arkanoid.envs.draw.palette import CAPSULE_BODY, LUMA, PALETTE
from arkanoid.envs.game.capsules import capsule_by_weight
from arkanoid.envs.observe.planes import STATUS
from arkanoid.envs.play.things import CAPSULE_THINGS
from arkanoid.envs.rules import CAPSULES, FAST, PADDLE_TOP

NOOP, FIRE = 0, 3

env = ArkanoidEnv(frame_skip=1)
env.reset(seed=0)
env.step(FIRE)
world = env._batch.worlds[0]
slow = math.hypot(world.ball_vx[0], world.ball_vy[0])
world.capsule, world.capsule_x, world.capsule_y = FAST, world.paddle_x, PADDLE_TOP + 1.0
observation, *_ = env.step(NOOP)
assert observation[env.layout["capsule"]].tolist() == [0, 0, 0, 0, 0, 0, 0, 1]
while world.capsule == FAST:
    env.step(NOOP)
assert (world.capsules_caught, world.speed_stage) == (1, 2)
# Each stage adds a quarter of the first stage's speed.
assert abs(math.hypot(world.ball_vx[0], world.ball_vy[0]) / slow - 1.5) < 1e-12

assert "capsule_fast" in STATUS
assert sorted(STATUS.values()) == list(range(len(STATUS)))
colours = PALETTE[CAPSULE_BODY + 1 : CAPSULE_BODY + 1 + CAPSULES]
assert np.diff(np.sort(colours @ LUMA)).min() >= 20

assert [thing.name.split()[1] for thing in CAPSULE_THINGS][-1] == "fast"  # on the help card

drawn = [capsule_by_weight((place + 0.5) / 65536) for place in range(65536)]
assert abs(drawn.count(FAST) / 65536 - 250 / 256 / 16) < 1e-4
assert sorted(set(drawn)) == list(range(1, CAPSULES + 1))
