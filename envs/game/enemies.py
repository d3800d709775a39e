"""Enemies: they come in through gates in the ceiling, drift down, circle, and dive at the paddle.

Like the paddle's, an enemy's motion in a tick is planned before anything moves. It is straight, so
that the exact time is known at which a ball hits the enemy.
"""

import math

from ...physics.kernels import inlined, inner
from ...physics.pairs.approach import approach_between, will_touch
from ...physics.pairs.response import reflect
from ...physics.pairs.shape_lattice import sweep_shape_lattice
from ...physics.pairs.table import overlap_between
from ..rules import (
    CIRCLE_HEIGHT,
    CIRCLE_SPEED,
    CIRCLE_TICKS,
    CLEARANCE,
    DIVE_SPEED,
    ENEMY_KINDS,
    ENEMY_POINTS,
    ENEMY_SPEED,
    ENEMY_TICKS_MAX,
    ENEMY_TICKS_MIN,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    GATE_TICKS,
    GATE_X,
    GATES,
    MAX_ENEMIES,
    PADDLE_Y,
)
from ..state import (
    ABSENT,
    CIRCLING,
    DIVING,
    DRIFTING,
    ENTERING,
    HIGHEST,
    RulesRecord,
    WorldRecord,
)
from .random import random_sign, uniform, uniform_between
from .scoring import add_score
from .shapes import BRICK_SHAPE, CEILING_SHAPE, ENEMY_SHAPE, LEFT_WALL_SHAPE, RIGHT_WALL_SHAPE

# The heights at which an enemy starts above the ceiling, and leaves the game below the field.
ABOVE = FIELD_HEIGHT + 0.4
BELOW = -1.0


@inner
def remove_enemy(world: WorldRecord, enemy: int) -> None:
    """Remove an enemy."""
    world.enemies -= world.enemy_state[enemy] != ABSENT
    world.enemy_state[enemy] = ABSENT
    world.enemy_kind[enemy] = 0
    world.enemy_x[enemy] = 0.0
    world.enemy_y[enemy] = 0.0
    world.enemy_vx[enemy] = 0.0
    world.enemy_vy[enemy] = 0.0
    world.enemy_course_x[enemy] = 0.0
    world.enemy_course_y[enemy] = 0.0
    world.enemy_side[enemy] = 0.0
    world.enemy_clock[enemy] = 0


@inlined
def remove_enemies(world: WorldRecord) -> None:
    """Remove all enemies, and draw when and where the next one comes in."""
    for enemy in range(MAX_ENEMIES):
        remove_enemy(world, enemy)
    _draw_gate(world)


@inner
def _draw_gate(world: WorldRecord) -> None:
    """Draw when and through which gate the next enemy comes in."""
    world.enemy_wait = int(uniform_between(world, ENEMY_TICKS_MIN, ENEMY_TICKS_MAX))
    world.enemy_gate = int(uniform(world) * GATES)


@inner
def destroy_enemy(world: WorldRecord, enemy: int) -> None:
    """Remove an enemy that the player has destroyed, and add its points."""
    remove_enemy(world, enemy)
    world.enemies_destroyed += 1
    add_score(world, ENEMY_POINTS)


@inlined
def open_gates(world: WorldRecord) -> None:
    """Count down to the next enemy, and let it in; gates stay closed while the field is full."""
    if world.enemies < MAX_ENEMIES or world.enemy_wait > GATE_TICKS:
        world.enemy_wait -= 1
    if world.enemy_wait > 0:
        return
    for enemy in range(MAX_ENEMIES):
        if world.enemy_state[enemy] == ABSENT:
            _enter(world, enemy)
            return


@inner
def _enter(world: WorldRecord, enemy: int) -> None:
    """Let an enemy that is not there yet come in through the open gate."""
    world.enemies += 1
    world.enemy_state[enemy] = ENTERING
    world.enemy_kind[enemy] = int(uniform(world) * ENEMY_KINDS)
    world.enemy_side[enemy] = random_sign(world)
    world.enemy_x[enemy] = GATE_X[world.enemy_gate]
    world.enemy_y[enemy] = ABOVE
    _draw_gate(world)


@inner
def steer_enemies(world: WorldRecord, rules: RulesRecord) -> None:
    """Plan each enemy's motion in this tick, one after the other.

    The way of an enemy is blocked by the planned ways of earlier ones, and by the places where
    later ones still are.
    """
    for enemy in range(MAX_ENEMIES):
        world.enemy_vx[enemy] = 0.0
        world.enemy_vy[enemy] = 0.0
    for enemy in range(MAX_ENEMIES):
        state = world.enemy_state[enemy]
        if state in (ENTERING, DRIFTING):
            _drift(world, rules, enemy)
        elif state != ABSENT:
            _fly(world, rules, enemy)


@inlined
def _drift(world: WorldRecord, rules: RulesRecord, enemy: int) -> None:
    """Move an enemy down if the way is free, or else sideways; at an obstacle it turns round."""
    shape = ENEMY_SHAPE + world.enemy_kind[enemy]
    if world.enemy_state[enemy] == ENTERING and not overlap_between(
        rules.shapes,
        rules.edges,
        CEILING_SHAPE,
        shape,
        world.enemy_x[enemy],
        world.enemy_y[enemy] - FIELD_HEIGHT,
    ):
        world.enemy_state[enemy] = DRIFTING
    if world.enemy_y[enemy] <= CIRCLE_HEIGHT:
        world.enemy_state[enemy] = CIRCLING
        world.enemy_clock[enemy] = 0
        world.enemy_course_x[enemy] = 0.0
        world.enemy_course_y[enemy] = -1.0
    x, y, speed = 0.0, -1.0, ENEMY_SPEED
    part, _, _ = _free_way(world, rules, enemy, x * speed, y * speed)
    if part == 0.0:
        x, y = world.enemy_side[enemy], 0.0
        part, _, _ = _free_way(world, rules, enemy, x * speed, y * speed)
        if part == 0.0:
            world.enemy_side[enemy] = -world.enemy_side[enemy]
    world.enemy_vx[enemy] = x * speed * part
    world.enemy_vy[enemy] = y * speed * part


@inlined
def _fly(world: WorldRecord, rules: RulesRecord, enemy: int) -> None:
    """Let an enemy circle for a while, and then dive; it bounces off what blocks its way."""
    x, y = world.enemy_course_x[enemy], world.enemy_course_y[enemy]
    speed = DIVE_SPEED
    if world.enemy_state[enemy] == CIRCLING:
        world.enemy_clock[enemy] = min(world.enemy_clock[enemy] + 1, CIRCLE_TICKS)
        speed = CIRCLE_SPEED
        if world.enemy_clock[enemy] < CIRCLE_TICKS:
            sine = rules.circle_sine * world.enemy_side[enemy]
            x, y = x * rules.circle_cosine - y * sine, x * sine + y * rules.circle_cosine
        else:
            world.enemy_state[enemy] = DIVING
            speed = DIVE_SPEED
            x, y = world.paddle_x - world.enemy_x[enemy], PADDLE_Y - world.enemy_y[enemy]
        length = math.sqrt(x * x + y * y)
        x, y = x / length, y / length
    part, normal_x, normal_y = _free_way(world, rules, enemy, x * speed, y * speed)
    world.enemy_vx[enemy] = x * speed * part
    world.enemy_vy[enemy] = y * speed * part
    if part < 1.0:
        x, y = reflect(x, y, normal_x, normal_y, 1.0)
        world.enemy_side[enemy] = -world.enemy_side[enemy]
        if world.enemy_state[enemy] == DIVING:
            world.enemy_state[enemy] = DRIFTING
    world.enemy_course_x[enemy] = x
    world.enemy_course_y[enemy] = y


@inner
def _free_way(
    world: WorldRecord, rules: RulesRecord, enemy: int, vx: float, vy: float
) -> tuple[float, float, float]:
    """Return (part, normal_x, normal_y): the free part of a tick's motion, and what blocks it.

    The part is between 0 and 1. The normal, of the obstacle, is 0 if nothing blocks the way.
    """
    # Looking a little further ahead keeps the clearance.
    ahead = CLEARANCE / math.sqrt(vx * vx + vy * vy)
    time, normal_x, normal_y = _first_obstacle(world, rules, enemy, vx, vy, 1.0 + ahead)
    for other in range(MAX_ENEMIES):
        if other == enemy or world.enemy_state[other] == ABSENT:
            continue
        met, hit_x, hit_y = approach_between(
            rules.shapes,
            rules.edges,
            ENEMY_SHAPE + world.enemy_kind[other],
            ENEMY_SHAPE + world.enemy_kind[enemy],
            world.enemy_x[enemy] - world.enemy_x[other],
            world.enemy_y[enemy] - world.enemy_y[other],
            vx - world.enemy_vx[other],
            vy - world.enemy_vy[other],
            1.0 + ahead,
        )
        if met < math.inf:
            # The other one goes on along its way, so this one must not move at all.
            return 0.0, hit_x, hit_y
    part = min(1.0, time - ahead)
    # Where the way has ended, a rounding error leaves a smaller part than this, again and again.
    return part if part > CLEARANCE else 0.0, normal_x, normal_y


@inlined
def _first_obstacle(
    world: WorldRecord, rules: RulesRecord, enemy: int, vx: float, vy: float, duration: float
) -> tuple[float, float, float]:
    """Return (time, normal_x, normal_y) of an enemy's first impact on bricks and walls."""
    shape = ENEMY_SHAPE + world.enemy_kind[enemy]
    x, y = world.enemy_x[enemy], world.enemy_y[enemy]
    time, normal_x, normal_y, _ = sweep_shape_lattice(
        rules.shapes,
        rules.edges,
        shape,
        BRICK_SHAPE,
        rules.lattice[0],
        world.brick_hits,
        x,
        y,
        vx,
        vy,
        duration,
    )
    wall = LEFT_WALL_SHAPE if vx < 0.0 else RIGHT_WALL_SHAPE
    wall_x = 0.0 if vx < 0.0 else FIELD_WIDTH
    met, hit_x, hit_y = approach_between(
        rules.shapes, rules.edges, wall, shape, x - wall_x, y, vx, vy, duration
    )
    if met < time:
        return met, hit_x, hit_y
    return time, normal_x, normal_y


@inner
def meet_enemies(
    world: WorldRecord,
    rules: RulesRecord,
    shape: int,
    x: float,
    y: float,
    vx: float,
    vy: float,
    elapsed: float,
    duration: float,
) -> tuple[float, float, float, int]:
    """Return (time, normal_x, normal_y, enemy) of a moving shape's first impact on an enemy.

    Args:
        elapsed: of the tick, when the shape is at (x, y).
    """
    time, normal_x, normal_y, first = math.inf, 0.0, 0.0, -1
    for enemy in range(MAX_ENEMIES):
        if world.enemy_state[enemy] == ABSENT:
            continue
        enemy_vx, enemy_vy = world.enemy_vx[enemy], world.enemy_vy[enemy]
        met, hit_x, hit_y = approach_between(
            rules.shapes,
            rules.edges,
            ENEMY_SHAPE + world.enemy_kind[enemy],
            shape,
            x - (world.enemy_x[enemy] + enemy_vx * elapsed),
            y - (world.enemy_y[enemy] + enemy_vy * elapsed),
            vx - enemy_vx,
            vy - enemy_vy,
            duration,
        )
        if met < time:
            time, normal_x, normal_y, first = met, hit_x, hit_y, enemy
    return time, normal_x, normal_y, first


@inlined
def move_enemies(world: WorldRecord, rules: RulesRecord) -> None:
    """Move the enemies by one tick; the paddle destroys those that it touches."""
    for enemy in range(MAX_ENEMIES):
        if world.enemy_state[enemy] == ABSENT:
            continue
        if will_touch(
            rules.shapes,
            rules.edges,
            world.paddle_shape,
            ENEMY_SHAPE + world.enemy_kind[enemy],
            world.enemy_x[enemy] - world.paddle_x,
            world.enemy_y[enemy] - PADDLE_Y,
            world.enemy_vx[enemy] - world.paddle_vx,
            world.enemy_vy[enemy],
            1.0,
        ):
            destroy_enemy(world, enemy)
            continue
        world.enemy_x[enemy] += world.enemy_vx[enemy]
        world.enemy_y[enemy] = min(world.enemy_y[enemy] + world.enemy_vy[enemy], HIGHEST)
        if world.enemy_y[enemy] < BELOW:
            remove_enemy(world, enemy)
