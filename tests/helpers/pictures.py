"""Worlds to be drawn, and where their things lie in a picture."""

from typing import Any

import numpy as np
from arkanoid.envs.batch.batch import Batch
from arkanoid.envs.config import Config
from arkanoid.envs.draw.picture import draw_world
from arkanoid.envs.draw.view import make_view
from arkanoid.envs.game.shapes import (
    LONG_PADDLE_SHAPE,
    PADDLE_SHAPE,
)
from arkanoid.envs.rules import (
    BOSS_HITS,
    CAPSULES,
    CELLS,
    ENEMY_KINDS,
    ENLARGE,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    GATE_TICKS,
    GATE_X,
    GOLD,
    MAX_BALLS,
    MAX_BEAMS,
    MAX_ENEMIES,
    MAX_SHARDS,
    POWERS,
    SILVER,
    UNBREAKABLE,
)
from arkanoid.envs.state import ABSENT, CIRCLING, ENTERING, FLYING
from hypothesis import settings
from numpy.typing import NDArray
from shapely import Polygon, area, box, intersection
from shapely.affinity import affine_transform

# The first example of a size draws its background and may compile kernels.
PROPERTY = settings(max_examples=40)


SIZES = [(84, 84), (210, 160), (512, 384)]


def new_game(**keywords: Any) -> Batch:
    """A game that has just begun."""
    batch = Batch(1, Config(**keywords))
    batch.seed(0, 1)
    batch.reset(np.ones(1, np.bool_))
    return batch


def empty_game(**keywords: Any) -> Batch:
    """A game without bricks and ball, the paddle out of sight, and no enemy about to come."""
    batch = new_game(**keywords)
    world = batch.worlds[0]
    world.brick_hits[:] = 0
    world.paddle_x = -9.0
    world.ball_state[0] = ABSENT
    world.enemy_wait = 10 * GATE_TICKS
    return batch


def picture(
    batch: Batch, height: int = 512, width: int | None = None, channels: int = 3
) -> NDArray[np.uint8]:
    """A fresh picture of a batch's first world."""
    return draw_world(batch.worlds, batch.rules, 0, height, width, channels)


def changed(one: NDArray[np.uint8], other: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """The pixels in which two pictures differ, bool [height, width]."""
    return (one != other).any(axis=2)


def pixel_areas(region: Any, height: int, width: int) -> NDArray[np.float64]:
    """The area of a Shapely region within each pixel."""
    areas = np.zeros((height, width))
    left, top, right, bottom = (int(bound) for bound in region.bounds)
    columns, rows = np.meshgrid(
        np.arange(max(left - 1, 0), min(right + 2, width)),
        np.arange(max(top - 1, 0), min(bottom + 2, height)),
    )
    areas[rows, columns] = area(intersection(box(columns, rows, columns + 1, rows + 1), region))
    return areas


def to_pixels(height: int, width: int, x: float, y: float) -> tuple[float, float]:
    """The pixel coordinates of a point of the field."""
    view = make_view(height, width)[0]
    return view.left + x * view.scale, view.bottom - y * view.scale


def region_in_pixels(region: Polygon, height: int, width: int, x: float, y: float) -> Any:
    """A region that is moved to (x, y) of the field, in pixels."""
    left, top = to_pixels(height, width, x, y)
    scale = make_view(height, width)[0].scale
    return affine_transform(region, [scale, 0.0, 0.0, -scale, left, top])


def outline(collider: Any) -> Polygon:
    """The region of a collider with edges, in body coordinates."""
    return Polygon([(edge.start_x, edge.start_y) for edge in collider.edges])


def upright(width: float, height: float) -> Polygon:
    """A box about the origin."""
    return box(-width / 2, -height / 2, width / 2, height / 2)


def put_paddle(world: Any, x: float, y: float) -> None:
    world.paddle_x = x


def put_long_paddle(world: Any, x: float, y: float) -> None:
    world.paddle_shape, world.paddle_half, world.paddle_x = LONG_PADDLE_SHAPE, 1.5, x


def put_power(power: int) -> Any:
    def put(world: Any, x: float, y: float) -> None:
        world.paddle_x, world.power = x, power
        if power == ENLARGE:
            put_long_paddle(world, x, y)

    return put


def put_enemy(kind: int) -> Any:
    def put(world: Any, x: float, y: float) -> None:
        world.enemies, world.enemy_state[1], world.enemy_kind[1] = 1, CIRCLING, kind
        world.enemy_x[1], world.enemy_y[1] = x, y

    return put


def put_boss(world: Any, x: float, y: float) -> None:
    world.boss_hits = BOSS_HITS


def put_beaten_boss(world: Any, x: float, y: float) -> None:
    world.boss_hits, world.shard_wait = 1, 0


def put_shard(world: Any, x: float, y: float) -> None:
    world.shards, world.shard_state[2], world.shard_x[2], world.shard_y[2] = 1, FLYING, x, y


def put_beam(world: Any, x: float, y: float) -> None:
    world.beams, world.beam_state[3], world.beam_x[3], world.beam_y[3] = 1, FLYING, x, y


def put_capsule(kind: int) -> Any:
    def put(world: Any, x: float, y: float) -> None:
        world.capsule, world.capsule_x, world.capsule_y = kind, x, y

    return put


def random_scene(batch: Batch, random: np.random.Generator) -> None:
    """Change about half of what a picture shows, to anything that the state can hold."""
    world, worlds = batch.worlds[0], batch.worlds

    def chance() -> bool:
        return bool(random.random() < 0.5)

    def scatter(name: str, count: int, states: list[int]) -> None:
        worlds[f"{name}_state"][0] = random.choice([ABSENT, *states], count)
        worlds[f"{name}_x"][0] = random.uniform(-0.5, FIELD_WIDTH + 0.5, count)
        top = FIELD_HEIGHT + 0.4 if name == "enemy" else FIELD_HEIGHT - 0.25
        worlds[f"{name}_y"][0] = random.uniform(-0.7, top, count)

    if chance():
        world.round_number = random.choice([1, 2, 9, 30])
        worlds["kind"][0] = random.integers(0, GOLD + 1, CELLS)
    if chance():
        some = random.random(CELLS) < random.choice([0.02, 0.5])
        hits = np.where(worlds["kind"][0] == SILVER, random.integers(0, 4, CELLS), 1)
        hits = np.where(random.random(CELLS) < 0.3, 0, hits)
        hits[worlds["kind"][0] == 0] = 0
        hits[worlds["kind"][0] == GOLD] = UNBREAKABLE
        worlds["brick_hits"][0] = np.where(some, hits, worlds["brick_hits"][0])
    if chance():
        world.score, world.lives = random.integers(0, 10**7), random.integers(0, 8)
    if chance():
        world.idle, world.decisions = random.integers(0, 3601), random.integers(0, 27_001)
    if chance():
        world.power = random.integers(0, POWERS + 1)
        world.paddle_shape = LONG_PADDLE_SHAPE if world.power == ENLARGE else PADDLE_SHAPE
        world.paddle_half = 1.5 if world.power == ENLARGE else 1.0
        world.exit_open = chance()
    if chance():
        world.paddle_x = random.uniform(0.0, FIELD_WIDTH)
    if chance():
        scatter("ball", MAX_BALLS, [FLYING])
    if chance():
        world.capsule = random.integers(0, CAPSULES + 1)
        world.capsule_x = random.uniform(0.0, FIELD_WIDTH)
        world.capsule_y = random.uniform(-0.2, FIELD_HEIGHT - 1.0)
    if chance():
        scatter("beam", MAX_BEAMS, [FLYING])
        world.beams = (worlds["beam_state"][0] != ABSENT).sum()
    if chance():
        scatter("enemy", MAX_ENEMIES, [ENTERING, CIRCLING])
        worlds["enemy_kind"][0] = random.integers(0, ENEMY_KINDS, MAX_ENEMIES)
        worlds["enemy_vx"][0], worlds["enemy_vy"][0] = random.normal(size=(2, MAX_ENEMIES)) * 0.05
        entering = worlds["enemy_state"][0] == ENTERING
        worlds["enemy_x"][0][entering] = random.choice(GATE_X)
        world.enemies = (worlds["enemy_state"][0] != ABSENT).sum()
        world.enemy_wait, world.enemy_gate = random.integers(1, 2 * GATE_TICKS), random.integers(2)
    if chance():
        world.boss_hits = random.choice([0, random.integers(1, BOSS_HITS + 1)])
        world.shard_wait = random.integers(0, 60)
        scatter("shard", MAX_SHARDS, [FLYING])
        world.shards = (worlds["shard_state"][0] != ABSENT).sum()
