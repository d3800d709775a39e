"""The boss: it takes many hits, and throws shards at the paddle that cost a life."""

import math

from ...physics.kernels import inlined, inner
from ...physics.pairs.approach import approach_between, will_touch
from ..rules import (
    BOSS_POINTS,
    BOSS_X,
    BOSS_Y,
    FIELD_WIDTH,
    MAX_SHARDS,
    PADDLE_Y,
    SHARD_SPEED,
    SHARD_TICKS,
)
from ..state import ABSENT, FLYING, RulesRecord, WorldRecord
from .scoring import add_score, count_damage
from .shapes import BOSS_SHAPE, SHARD_SHAPE

# Shards start this far below the boss's middle.
MOUTH = 1.0


@inner
def meet_boss(
    rules: RulesRecord, shape: int, x: float, y: float, vx: float, vy: float, duration: float
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) of a moving shape's impact on the boss; inf if none."""
    return approach_between(
        rules.shapes, rules.edges, BOSS_SHAPE, shape, x - BOSS_X, y - BOSS_Y, vx, vy, duration
    )


@inner
def hit_boss(world: WorldRecord) -> None:
    """Hit the boss once; the last hit removes the boss and all shards."""
    world.boss_hits -= 1
    add_score(world, BOSS_POINTS)
    count_damage(world)
    if world.boss_hits == 0:
        remove_shards(world)


@inner
def remove_shard(world: WorldRecord, shard: int) -> None:
    """Remove a shard."""
    world.shards -= world.shard_state[shard] != ABSENT
    world.shard_state[shard] = ABSENT
    world.shard_x[shard] = 0.0
    world.shard_y[shard] = 0.0
    world.shard_vx[shard] = 0.0
    world.shard_vy[shard] = 0.0


@inner
def remove_shards(world: WorldRecord) -> None:
    """Remove all shards; the boss waits before it throws again."""
    for shard in range(MAX_SHARDS):
        remove_shard(world, shard)
    world.shard_wait = SHARD_TICKS


@inlined
def throw_shards(world: WorldRecord) -> None:
    """Let the boss throw a shard towards the paddle when it has waited long enough."""
    world.shard_wait = max(0, world.shard_wait - 1)
    if world.shard_wait > 0 or world.shards == MAX_SHARDS:
        return
    for shard in range(MAX_SHARDS):
        if world.shard_state[shard] == ABSENT:
            _throw_shard(world, shard)
            return


@inner
def _throw_shard(world: WorldRecord, shard: int) -> None:
    """Throw a shard that is not there yet towards the paddle."""
    x, y = world.paddle_x - BOSS_X, PADDLE_Y - (BOSS_Y - MOUTH)
    part = SHARD_SPEED / math.sqrt(x * x + y * y)
    world.shards += 1
    world.shard_state[shard] = FLYING
    world.shard_x[shard] = BOSS_X
    world.shard_y[shard] = BOSS_Y - MOUTH
    world.shard_vx[shard] = x * part
    world.shard_vy[shard] = y * part
    world.shard_wait = SHARD_TICKS


@inlined
def fly_shards(world: WorldRecord, rules: RulesRecord) -> bool:
    """Move the shards by one tick; return whether one has hit the moving paddle."""
    landed = False
    for shard in range(MAX_SHARDS):
        if world.shard_state[shard] == ABSENT:
            continue
        landed = landed or will_touch(
            rules.shapes,
            rules.edges,
            world.paddle_shape,
            SHARD_SHAPE,
            world.shard_x[shard] - world.paddle_x,
            world.shard_y[shard] - PADDLE_Y,
            world.shard_vx[shard] - world.paddle_vx,
            world.shard_vy[shard],
            1.0,
        )
        world.shard_x[shard] += world.shard_vx[shard]
        world.shard_y[shard] += world.shard_vy[shard]
        x = world.shard_x[shard]
        if world.shard_y[shard] < 0.0 or x < 0.0 or x > FIELD_WIDTH:
            remove_shard(world, shard)
    return landed
