"""The laser's beams: each shot is two, which fly straight up and hit what they meet first."""

from ...physics.kernels import inlined, inner
from ...physics.pairs.approach import approach_between
from ...physics.pairs.shape_lattice import sweep_shape_lattice
from ..rules import (
    BEAM_HEIGHT,
    BEAM_PLACE,
    BEAM_SPEED,
    BEAM_TICKS,
    FIELD_HEIGHT,
    LASER,
    MAX_BEAMS,
    PADDLE_TOP,
)
from ..state import ABSENT, FLYING, RulesRecord, WorldRecord
from .boss import hit_boss, meet_boss
from .bricks import hit_brick
from .enemies import destroy_enemy, meet_enemies
from .shapes import BEAM_SHAPE, BOSS, BRICK, BRICK_SHAPE, CEILING, CEILING_SHAPE, ENEMY, NOTHING


@inner
def remove_beam(world: WorldRecord, beam: int) -> None:
    """Remove a beam."""
    world.beams -= world.beam_state[beam] != ABSENT
    world.beam_state[beam] = ABSENT
    world.beam_x[beam] = 0.0
    world.beam_y[beam] = 0.0


@inlined
def remove_beams(world: WorldRecord) -> None:
    """Remove all beams; the laser is ready to shoot."""
    for beam in range(MAX_BEAMS):
        remove_beam(world, beam)
    world.beam_wait = 0


@inlined
def shoot(world: WorldRecord, rules: RulesRecord) -> None:
    """Shoot two beams if the laser is ready and the player fires."""
    world.beam_wait = max(0, world.beam_wait - 1)
    if world.power != LASER or world.beam_wait > 0 or world.beams > MAX_BEAMS - 2:
        return
    if world.fire > 0.0 or rules.auto_fire == 1:
        world.beam_wait = BEAM_TICKS
        _start_beam(world, -BEAM_PLACE * world.paddle_half)
        _start_beam(world, BEAM_PLACE * world.paddle_half)


@inner
def _start_beam(world: WorldRecord, offset: float) -> None:
    """Let a beam start on the paddle, at an offset from its middle."""
    for beam in range(MAX_BEAMS):
        if world.beam_state[beam] == ABSENT:
            world.beams += 1
            world.beam_state[beam] = FLYING
            world.beam_x[beam] = world.paddle_x + offset
            world.beam_y[beam] = PADDLE_TOP + 0.5 * BEAM_HEIGHT
            return


@inner
def fly_beams(world: WorldRecord, rules: RulesRecord) -> None:
    """Move the beams by one tick; each ends at the first thing that it hits."""
    for beam in range(MAX_BEAMS):
        if world.beam_state[beam] == ABSENT or world.cleared == 1:
            continue
        what, index = _first_impact(world, rules, world.beam_x[beam], world.beam_y[beam])
        world.beam_y[beam] += BEAM_SPEED
        if what == NOTHING:
            continue
        remove_beam(world, beam)
        if what == BRICK:
            hit_brick(world, rules, index)
        elif what == ENEMY:
            destroy_enemy(world, index)
        elif what == BOSS:
            hit_boss(world)


@inlined
def _first_impact(world: WorldRecord, rules: RulesRecord, x: float, y: float) -> tuple[int, int]:
    """Return what a beam at (x, y) meets first in this tick, and which one."""
    what, index = NOTHING, -1
    time, _, _ = approach_between(
        rules.shapes,
        rules.edges,
        CEILING_SHAPE,
        BEAM_SHAPE,
        x,
        y - FIELD_HEIGHT,
        0.0,
        BEAM_SPEED,
        1.0,
    )
    if time <= 1.0:
        what = CEILING
    met, _, _, cell = sweep_shape_lattice(
        rules.shapes,
        rules.edges,
        BEAM_SHAPE,
        BRICK_SHAPE,
        rules.lattice[0],
        world.brick_hits,
        x,
        y,
        0.0,
        BEAM_SPEED,
        1.0,
    )
    if met < time:
        time, what, index = met, BRICK, cell
    if world.enemies > 0:
        met, _, _, enemy = meet_enemies(world, rules, BEAM_SHAPE, x, y, 0.0, BEAM_SPEED, 0.0, 1.0)
        if met < time:
            time, what, index = met, ENEMY, enemy
    if world.boss_hits > 0:
        met, _, _ = meet_boss(rules, BEAM_SHAPE, x, y, 0.0, BEAM_SPEED, 1.0)
        if met < time:
            what = BOSS
    return what, index
