"""Pictures of a world: every thing is where the rules say, and nothing else is touched."""

import hashlib
import os
import subprocess
import sys
from functools import cache
from typing import Any

import numpy as np
import pytest
from arkanoid.envs.batch.batch import Batch
from arkanoid.envs.config import Config
from arkanoid.envs.draw.canvas import Drawn
from arkanoid.envs.draw.frame import draw_frame
from arkanoid.envs.draw.palette import BRICK, CAPSULE, LUMA, PALETTE
from arkanoid.envs.draw.picture import draw_world
from arkanoid.envs.draw.scenery import scenery
from arkanoid.envs.draw.view import FULL_HEIGHT, FULL_WIDTH, HEADER_SCALE, make_view
from arkanoid.envs.game.shapes import (
    LONG_PADDLE_SHAPE,
    PADDLE_SHAPE,
    boss_collider,
    enemy_colliders,
    paddle_collider,
    shard_collider,
)
from arkanoid.envs.rules import (
    BALL_RADIUS,
    BEAM_HEIGHT,
    BEAM_WIDTH,
    BOSS_HITS,
    BOSS_X,
    BOSS_Y,
    BRICK_HEIGHT,
    BRICK_WIDTH,
    CAPSULE_HEIGHT,
    CAPSULE_WIDTH,
    CAPSULES,
    CATCH,
    CELLS,
    COLOURS,
    COLUMNS,
    ENEMY_KINDS,
    ENLARGE,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    GATE_TICKS,
    GATE_X,
    GOLD,
    LASER,
    LATTICE_TOP,
    MAX_BALLS,
    MAX_BEAMS,
    MAX_ENEMIES,
    MAX_SHARDS,
    NO_CAPSULE,
    PADDLE_Y,
    POWERS,
    ROWS,
    SILVER,
    UNBREAKABLE,
)
from arkanoid.envs.state import ABSENT, CIRCLING, ENTERING, FLYING
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from shapely import Point, Polygon, area, box, intersection
from shapely.affinity import affine_transform

# The first example of a size draws its background and may compile kernels.
PROPERTY = settings(deadline=None, max_examples=40)
SIZES = [(84, 84), (210, 160), (512, 384)]


def new_game(**keywords: Any) -> Batch:
    batch = Batch(1, Config(**keywords))
    batch.seed(0, 1)
    batch.reset(np.ones(1, np.bool_))
    return batch


def picture(
    batch: Batch, height: int = 512, width: int | None = None, channels: int = 3
) -> NDArray[np.uint8]:
    return draw_world(batch.worlds, batch.rules, 0, height, width, channels)


def changed(one: NDArray[np.uint8], other: NDArray[np.uint8]) -> NDArray[np.bool_]:
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


def place(height: int, width: int, x: float, y: float) -> tuple[float, float]:
    view = make_view(height, width)[0]
    return view.left + x * view.scale, view.bottom - y * view.scale


def test_the_default_picture_has_32_pixels_a_brick() -> None:
    frame = picture(new_game())
    assert frame.shape == (512, 384, 3)
    assert frame.dtype == np.uint8
    assert make_view(512, 384)[0].scale == 32.0
    assert place(512, 384, 0.0, 0.0) == (16.0, 512.0)


@PROPERTY
@given(height=st.integers(1, 400), width=st.integers(1, 400))
def test_the_field_fits_any_size_and_is_centred(height: int, width: int) -> None:
    view = make_view(height, width)[0]
    left, right = place(height, width, 0.0, 0.0)[0], place(height, width, FIELD_WIDTH, 0.0)[0]
    bottom, top = place(height, width, 0.0, 0.0)[1], place(height, width, 0.0, FIELD_HEIGHT)[1]
    # Its place is rounded to whole pixels.
    assert -0.5 <= top < bottom <= height + 0.5
    assert abs(left - (width - right)) <= 1.0
    shown = FULL_HEIGHT if view.header else FIELD_HEIGHT
    assert view.scale == min(height / shown, width / FULL_WIDTH)
    assert bool(view.header) == (min(height / FULL_HEIGHT, width / FULL_WIDTH) >= HEADER_SCALE)
    assert (np.diff(view.columns) >= 0).all()
    assert (np.diff(view.rows) >= 0).all()


@pytest.mark.parametrize("size", [(1, 1), (1, 300), (300, 1), (13, 7), (40, 40), (97, 101)])
def test_any_size_can_be_drawn(size: tuple[int, int]) -> None:
    assert picture(new_game(), *size).shape == (*size, 3)


def test_illegal_sizes_are_refused() -> None:
    batch = new_game()
    for size in (0, -3, 10**6):
        with pytest.raises(ValueError, match=f"height must be between 1 and .* got {size}"):
            picture(batch, size)
    with pytest.raises(TypeError, match="width must be an integer"):
        picture(batch, 84, 84.0)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"channels must be 1 .* got 4"):
        picture(batch, 84, 84, 4)


@pytest.mark.parametrize("size", SIZES)
def test_the_same_world_gives_the_same_bits_in_a_fresh_array(size: tuple[int, int]) -> None:
    batch = new_game()
    before = batch.worlds.copy()
    first = picture(batch, *size)
    kept = first.copy()
    first[:] = 7  # a caller may do as he likes with it
    second = picture(batch, *size)
    np.testing.assert_array_equal(second, kept)
    np.testing.assert_array_equal(batch.worlds, before)


# A game with one of everything.
SCRIPT = """
import hashlib, numpy as np
from arkanoid.envs.batch.batch import Batch
from arkanoid.envs.config import Config
from arkanoid.envs.draw.picture import draw_world
batch = Batch(1, Config())
batch.seed(0, 1)
batch.reset(np.ones(1, np.bool_))
world = batch.worlds[0]
world.ball_x[0], world.ball_y[0], world.paddle_x, world.score = 3.21, 4.56, 7.89, 9870
world.capsule, world.capsule_x, world.capsule_y, world.power, world.exit_open = 5, 8.03, 4.1, 3, 1
world.beams, world.beam_state[0], world.beam_x[0], world.beam_y[0] = 1, 2, 6.54, 3.9
world.enemies, world.enemy_wait, world.enemy_gate = 3, 11, 1
for enemy, (state, x, y) in enumerate(((1, 2.75, 14.2), (3, 1.2, 3.3), (4, 10.1, 2.7))):
    world.enemy_state[enemy], world.enemy_kind[enemy] = state, enemy + 1
    world.enemy_x[enemy], world.enemy_y[enemy] = x, y
    world.enemy_vx[enemy], world.enemy_vy[enemy] = 0.01 * enemy, -0.03
print([hashlib.sha256(draw_world(batch.worlds, batch.rules, 0, *size).tobytes()).hexdigest()
       for size in ((84, 84), (84, 84, 1), (130, 100))])
world.boss_hits, world.shard_wait, world.shards, world.shard_state[0] = 9, 7, 1, 2
world.shard_x[0], world.shard_y[0] = 4.44, 5.55
print([hashlib.sha256(draw_world(batch.worlds, batch.rules, 0, *size).tobytes()).hexdigest()
       for size in ((84, 84), (84, 84, 1), (130, 100))])
"""


def test_interpreted_kernels_draw_the_same_bits() -> None:
    printed = [
        subprocess.run(
            [sys.executable, "-c", SCRIPT],
            env=os.environ | {"NUMBA_DISABLE_JIT": disabled},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for disabled in ("0", "1")
    ]
    assert len(set(printed[0].split())) == 6
    assert printed[0] == printed[1]


@PROPERTY
@given(
    size=st.sampled_from(SIZES),
    x=st.floats(0.2, FIELD_WIDTH - 0.2),
    y=st.floats(0.2, FIELD_HEIGHT - 0.2),
)
def test_a_ball_appears_where_it_is_and_nowhere_else(
    size: tuple[int, int], x: float, y: float
) -> None:
    batch = new_game()
    world = batch.worlds[0]
    world.brick_hits[:] = 0
    world.paddle_x = -9.0  # out of the picture
    world.ball_state[0] = ABSENT
    without = picture(batch, *size)
    world.ball_state[2] = FLYING
    world.ball_x[2], world.ball_y[2] = x, y
    with_ball = picture(batch, *size)
    mask = changed(with_ball, without)
    centre = Point(*place(*size, x, y))
    radius = BALL_RADIUS * make_view(*size)[0].scale
    assert not mask[pixel_areas(centre.buffer(radius + 0.01), *size) == 0.0].any()
    # The disc's coverage may be wrong by 1 / 8, and what is left is bright on the dark field.
    assert mask[pixel_areas(centre.buffer(radius), *size) > 0.2].all()


def outline(collider: Any) -> Polygon:
    """The region of a collider with edges, in body coordinates."""
    return Polygon([(edge.start_x, edge.start_y) for edge in collider.edges])


def put_paddle(world: Any, x: float, y: float) -> None:
    world.paddle_x = x


def put_long_paddle(world: Any, x: float, y: float) -> None:
    world.paddle_shape, world.paddle_half, world.paddle_x = LONG_PADDLE_SHAPE, 1.5, x


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


def upright(width: float, height: float) -> Polygon:
    return box(-width / 2, -height / 2, width / 2, height / 2)


# Name: what puts it into a world, its region about its place, and where that is, if it is fixed
# (None: where the test says).
THINGS: dict[str, tuple[Any, Polygon, float | None, float | None]] = {
    "paddle": (put_paddle, outline(paddle_collider(2.0)), None, PADDLE_Y),
    "long paddle": (put_long_paddle, outline(paddle_collider(3.0)), None, PADDLE_Y),
    "boss": (put_boss, outline(boss_collider()), BOSS_X, BOSS_Y),
    "beaten boss": (put_beaten_boss, outline(boss_collider()), BOSS_X, BOSS_Y),
    "shard": (put_shard, outline(shard_collider()), None, None),
    "beam": (put_beam, upright(BEAM_WIDTH, BEAM_HEIGHT), None, None),
} | {
    f"enemy {kind}": (put_enemy(kind), outline(collider), None, None)
    for kind, collider in enumerate(enemy_colliders())
}
CAPSULE_REGION = upright(CAPSULE_WIDTH, CAPSULE_HEIGHT)


def empty_game(**keywords: Any) -> Batch:
    """A game without bricks, ball and (seen) paddle, in which no enemy is about to come."""
    batch = new_game(**keywords)
    world = batch.worlds[0]
    world.brick_hits[:] = 0
    world.paddle_x = -9.0
    world.ball_state[0] = ABSENT
    world.enemy_wait = 10 * GATE_TICKS
    return batch


def place_region(region: Polygon, height: int, width: int, x: float, y: float) -> Any:
    """A region about (x, y) of the field, in pixels."""
    left, top = place(height, width, x, y)
    scale = make_view(height, width)[0].scale
    return affine_transform(region, [scale, 0.0, 0.0, -scale, left, top])


@cache
def edge_colours(name: str, channels: int) -> NDArray[np.int64]:
    """Return the colours [n, channels] of what nothing but the edge of a thing covers."""
    put, region, fixed_x, fixed_y = THINGS[name]
    size, x, y = (1024, 1024), fixed_x or 5.0, fixed_y or 5.0
    batch = empty_game()
    put(batch.worlds[0], x, y)
    covered = pixel_areas(place_region(region, *size, x, y), *size)
    inner = pixel_areas(place_region(region.buffer(-0.05), *size, x, y), *size)
    shown = picture(batch, *size, channels)[(covered > 0.999) & (inner < 0.001)]
    return np.unique(shown, axis=0).astype(np.int64)


@pytest.mark.parametrize("name", THINGS)
@settings(deadline=None, max_examples=12)
@given(
    size=st.sampled_from(SIZES),
    channels=st.sampled_from([1, 3]),
    x=st.floats(1.5, FIELD_WIDTH - 1.5),
    y=st.floats(1.5, FIELD_HEIGHT - 1.5),
)
@example(size=(512, 384), channels=1, x=2.0, y=2.0)
def test_a_thing_covers_the_pixels_of_its_collider_and_no_other(
    name: str, size: tuple[int, int], channels: int, x: float, y: float
) -> None:
    """The picture shows what collides: where the collider is, all of it, and nothing beside it.

    (The example: in grey, a speck of the field's pattern is as bright as an enemy's rim, and a rim
    upon it was thought missing. A pixel changes by the part that is covered of how much the colours
    differ.)
    """
    put, region, fixed_x, fixed_y = THINGS[name]
    batch = empty_game()
    without = picture(batch, *size, channels)
    x, y = fixed_x or x, fixed_y or y
    put(batch.worlds[0], x, y)
    mask = changed(without, picture(batch, *size, channels))
    covered = pixel_areas(place_region(region, *size, x, y), *size)
    assert not mask[covered <= 1e-9].any()
    # Inside of its edge there may be dark eyes.
    inner = pixel_areas(place_region(region.buffer(-0.05), *size, x, y), *size)
    edge = (covered > 0.1) & (inner < 0.5)
    colours = edge_colours(name, channels)
    differ = np.abs(without.reshape(*size, 1, channels) - colours).max(axis=3).min(axis=2)
    assert mask[edge & (covered * differ >= 2)].all()
    assert mask[covered > 0.1].mean() > 0.8


@PROPERTY
@given(
    size=st.sampled_from(SIZES),
    kind=st.integers(1, CAPSULES),
    x=st.floats(1.5, FIELD_WIDTH - 1.5),
    y=st.floats(1.5, FIELD_HEIGHT - 1.5),
)
def test_a_capsule_covers_its_collider_but_for_rounded_corners(
    size: tuple[int, int], kind: int, x: float, y: float
) -> None:
    batch = empty_game()
    without = picture(batch, *size)
    put_capsule(kind)(batch.worlds[0], x, y)
    mask = changed(without, picture(batch, *size))
    covered = pixel_areas(place_region(CAPSULE_REGION, *size, x, y), *size)
    rounded = CAPSULE_REGION.buffer(-0.1).buffer(0.1)
    within = pixel_areas(place_region(rounded, *size, x, y), *size)
    assert not mask[covered <= 1e-9].any()
    # The corners' coverage may be wrong by 1 / 8.
    assert mask[within > 0.25].all()


def random_scene(batch: Batch, random: np.random.Generator) -> None:
    """Change about a half of all that a picture shows, to anything the state can hold."""
    world, worlds = batch.worlds[0], batch.worlds

    def chance() -> bool:
        return bool(random.random() < 0.5)

    def place_all(name: str, count: int, states: list[int]) -> None:
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
        world.power = random.integers(0, POWERS + 1)
        world.paddle_shape = LONG_PADDLE_SHAPE if world.power == ENLARGE else PADDLE_SHAPE
        world.paddle_half = 1.5 if world.power == ENLARGE else 1.0
        world.exit_open = chance()
    if chance():
        world.paddle_x = random.uniform(0.0, FIELD_WIDTH)
    if chance():
        place_all("ball", MAX_BALLS, [FLYING])
    if chance():
        world.capsule = random.integers(0, CAPSULES + 1)
        world.capsule_x = random.uniform(0.0, FIELD_WIDTH)
        world.capsule_y = random.uniform(-0.2, FIELD_HEIGHT - 1.0)
    if chance():
        place_all("beam", MAX_BEAMS, [FLYING])
        world.beams = (worlds["beam_state"][0] != ABSENT).sum()
    if chance():
        place_all("enemy", MAX_ENEMIES, [ENTERING, CIRCLING])
        worlds["enemy_kind"][0] = random.integers(0, ENEMY_KINDS, MAX_ENEMIES)
        worlds["enemy_vx"][0], worlds["enemy_vy"][0] = random.normal(size=(2, MAX_ENEMIES)) * 0.05
        entering = worlds["enemy_state"][0] == ENTERING
        worlds["enemy_x"][0][entering] = random.choice(GATE_X)
        world.enemies = (worlds["enemy_state"][0] != ABSENT).sum()
        world.enemy_wait, world.enemy_gate = random.integers(1, 2 * GATE_TICKS), random.integers(2)
    if chance():
        world.boss_hits = random.choice([0, random.integers(1, BOSS_HITS + 1)])
        world.shard_wait = random.integers(0, 60)
        place_all("shard", MAX_SHARDS, [FLYING])
        world.shards = (worlds["shard_state"][0] != ABSENT).sum()


class Canvas:
    """A picture that is drawn upon again and again."""

    def __init__(self, height: int, width: int, channels: int) -> None:
        self.sheets = scenery(height, width, channels)
        self.picture = np.full((height, width, channels), 77, np.uint8)
        self.lines = self.picture.reshape(height, -1)
        self.drawn = np.zeros(1, Drawn)

    def draw(self, batch: Batch, index: int = 0) -> None:
        world, rules = batch.worlds[index], batch.rules[0]
        draw_frame(self.picture, self.lines, self.drawn[0], self.sheets, world, rules)


@pytest.mark.parametrize(
    "size",
    [
        (84, 84, 1),
        (84, 84, 3),
        (97, 101, 1),
        (210, 160, 3),
        (256, 192, 3),
        (300, 130, 3),
        (150, 300, 1),
        (9, 5, 3),
        (1, 1, 1),
    ],
)
def test_a_picture_drawn_over_another_is_that_of_a_fresh_drawing(
    size: tuple[int, int, int],
) -> None:
    """To the bit, whatever the picture showed: this is what lets only the differences be drawn."""
    batch, canvas, random = new_game(), Canvas(*size), np.random.default_rng(size)
    for _ in range(60):
        random_scene(batch, random)
        canvas.draw(batch)
        np.testing.assert_array_equal(canvas.picture, picture(batch, *size))


def test_pictures_of_games_in_play_are_those_of_fresh_drawings() -> None:
    batch = Batch(3, Config(capsule_rate=1.0, lives=1000, actions="discrete3"))
    for index in range(3):
        batch.seed(index, index)
    batch.reset(np.ones(3, np.bool_))
    canvases = [Canvas(84, 84, 1) for _ in range(3)]
    random = np.random.default_rng(5)
    for _ in range(600):
        batch.command(random.integers(0, 3, 3))
        batch.step()
        for index, canvas in enumerate(canvases):
            canvas.draw(batch, index)
            fresh = draw_world(batch.worlds, batch.rules, index, 84, 84, 1)
            np.testing.assert_array_equal(canvas.picture, fresh)


@pytest.mark.parametrize("size", SIZES)
def test_grey_is_the_brightness_of_the_colours(size: tuple[int, int]) -> None:
    batch, random = new_game(), np.random.default_rng(3)
    for _ in range(10):
        random_scene(batch, random)
        grey = picture(batch, *size, 1)[:, :, 0]
        # Each layer of paint is rounded to a whole number, in both pictures by half a step at most.
        # No pixel has more than ten: field, gate, boss with rim, body, face, stroke; enemy and eye.
        assert np.abs(grey - picture(batch, *size) @ LUMA).max() <= 10


def test_nothing_is_seen_below_the_field_or_above_the_ceilings_wall() -> None:
    """Enemies come from above the ceiling, and much is lost below the field only when all is."""
    height, width = 400, 100
    batch, random = new_game(), np.random.default_rng(7)
    empty = picture(empty_game(), height, width)
    bottom = round(place(height, width, 0.0, 0.0)[1])
    top = place(height, width, 0.0, FIELD_HEIGHT + 0.5)[1]
    assert bottom < height
    for _ in range(100):
        random_scene(batch, random)
        batch.worlds["enemy_y"] = random.choice([0.0, 14.4], MAX_ENEMIES)
        batch.worlds["score"] = 0
        batch.worlds["lives"] = 3
        batch.worlds["round_number"] = 1
        batch.worlds["power"] = 0
        frame = picture(batch, height, width)
        np.testing.assert_array_equal(frame[bottom:], empty[bottom:])
        np.testing.assert_array_equal(frame[: int(top)], empty[: int(top)])


def thing_pictures(size: tuple[int, int], puts: list[Any]) -> list[NDArray[np.int64]]:
    """Greyscale pictures of things in the same place of an empty field."""
    pictures = []
    for put in puts:
        batch = empty_game()
        put(batch.worlds[0], 5.4, 6.1)
        pictures.append(picture(batch, *size, 1).astype(np.int64))
    return pictures


def put_power(power: int) -> Any:
    def put(world: Any, x: float, y: float) -> None:
        world.paddle_x, world.power = x, power
        if power == ENLARGE:
            put_long_paddle(world, x, y)

    return put


@pytest.mark.parametrize("size", [*SIZES, (84, 70)])
@pytest.mark.parametrize(
    "puts",
    [
        [put_capsule(kind) for kind in range(CAPSULES + 1)],
        [put_power(power) for power in (0, CATCH, ENLARGE, LASER)],
        [put_enemy(kind) for kind in range(ENEMY_KINDS)],
    ],
    ids=["capsules", "powers", "enemies"],
)
def test_kinds_of_things_differ_in_greyscale(size: tuple[int, int], puts: list[Any]) -> None:
    pictures = thing_pictures(size, puts)
    for index, one in enumerate(pictures):
        for other in pictures[index + 1 :]:
            # The least difference is of two capsules, whose bodies are 20 apart.
            assert np.abs(one - other).max() >= 16


def test_the_capsules_colours_are_steps_of_one_ladder_of_brightness() -> None:
    colours = PALETTE[CAPSULE + 1 : CAPSULE + 1 + CAPSULES]
    assert np.diff(np.sort(colours @ LUMA)).min() >= 20


@pytest.mark.parametrize("size", SIZES)
def test_each_hit_on_the_boss_is_seen(size: tuple[int, int]) -> None:
    batch = empty_game()
    looks = set()
    for hits in range(BOSS_HITS + 1):
        batch.worlds[0].boss_hits = hits
        batch.worlds[0].shard_wait = 90
        looks.add(picture(batch, *size).tobytes())
    assert len(looks) == BOSS_HITS + 1


def test_the_bosss_mouth_glows_before_it_throws() -> None:
    batch = empty_game()
    batch.worlds[0].boss_hits = BOSS_HITS
    reds = []
    for wait in (90, 40, 20, 10, 0):
        batch.worlds[0].shard_wait = wait
        reds.append(int(picture(batch)[:, :, 0].sum()))
    assert reds[0] == reds[1] < reds[2] < reds[3] < reds[4]


@pytest.mark.parametrize("size", SIZES)
def test_gates_open_before_an_enemy_comes_in(size: tuple[int, int]) -> None:
    """And stay open for it, each at its place, in the ceiling or, in small pictures, below it."""
    for gate, gate_x in enumerate(GATE_X):
        batch = empty_game()
        world = batch.worlds[0]
        closed = picture(batch, *size)
        world.enemy_gate = gate
        widths = []
        for wait in (GATE_TICKS, GATE_TICKS // 2, 0):
            world.enemy_wait = wait
            rows, columns = np.nonzero(changed(closed, picture(batch, *size)))
            widths.append(np.ptp(columns) + 1 if len(columns) else 0)
        assert widths[0] == 0 < widths[1] < widths[2]
        left, low = place(*size, gate_x - 0.5, FIELD_HEIGHT - 0.2)
        right, high = place(*size, gate_x + 0.5, FIELD_HEIGHT + 0.5)
        assert left - 1 < columns.min() <= columns.max() < right
        assert high - 1 < rows.min() <= rows.max() < low
        opened = picture(batch, *size)
        put_enemy(0)(world, gate_x, FIELD_HEIGHT + 0.9)  # not to be seen yet
        world.enemy_state[1] = ENTERING
        world.enemy_wait, world.enemy_gate = 300, 1 - gate
        np.testing.assert_array_equal(opened, picture(batch, *size))


@pytest.mark.parametrize("size", SIZES)
def test_the_open_exit_is_seen_in_the_right_wall_beside_the_paddle(size: tuple[int, int]) -> None:
    batch = empty_game()
    closed = picture(batch, *size)
    batch.worlds[0].exit_open = 1
    rows, columns = np.nonzero(changed(closed, picture(batch, *size)))
    assert columns.min() >= int(place(*size, FIELD_WIDTH, 0.0)[0])
    assert columns.max() < place(*size, FIELD_WIDTH + 0.5, 0.0)[0]
    assert rows.min() < place(*size, 0.0, PADDLE_Y)[1] < rows.max()


@pytest.mark.parametrize("power", [CATCH, ENLARGE, LASER])
def test_the_score_line_shows_the_power(power: int) -> None:
    batch = empty_game()
    without = picture(batch)
    batch.worlds[0].power = power
    rows, columns = np.nonzero(changed(without, picture(batch)))
    assert rows.max() < place(512, 384, 0.0, FIELD_HEIGHT + 0.5)[1]
    assert columns.min() > place(512, 384, 9.9, 0.0)[0]


def test_a_falling_capsule_is_drawn_with_its_letter() -> None:
    """Of the same capsule without its letter nothing but the letter's pixels differs."""
    batch = empty_game()
    assert batch.worlds[0].capsule == NO_CAPSULE
    inks = []
    for kind in range(1, CAPSULES + 1):
        put_capsule(kind)(batch.worlds[0], 5.5, 6.0)
        frame = picture(batch, 1024)
        left, top = (int(value) for value in place(1024, 768, 5.5 - 0.2, 6.0 + 0.14))
        body = PALETTE[CAPSULE + kind] @ LUMA
        inks.append(np.abs(frame[top : top + 18, left : left + 26] @ LUMA - body) > 60)
    for index, one in enumerate(inks):
        assert one.any()
        for other in inks[index + 1 :]:
            assert (one != other).sum() > 10


@PROPERTY
@given(
    size=st.sampled_from([*SIZES, (100, 100), (333, 251)]),
    row=st.integers(0, ROWS - 1),
    column=st.integers(0, COLUMNS - 1),
)
def test_removing_a_brick_changes_its_cell_and_no_other_pixel(
    size: tuple[int, int], row: int, column: int
) -> None:
    batch = new_game()
    batch.worlds["kind"] = 1 + (np.arange(ROWS * COLUMNS) % GOLD)
    batch.worlds[0].brick_hits[:] = 1
    full = picture(batch, *size)
    batch.worlds[0].brick_hits[row * COLUMNS + column] = 0
    rows, columns = np.nonzero(changed(full, picture(batch, *size)))
    left, top = place(*size, column * BRICK_WIDTH, LATTICE_TOP - row * BRICK_HEIGHT)
    scale = make_view(*size)[0].scale
    # Cells begin at whole pixels, at most half a pixel from their place.
    assert columns.min() >= left - 0.5
    assert columns.max() + 1 <= left + BRICK_WIDTH * scale + 0.5
    assert rows.min() >= top - 0.5
    assert rows.max() + 1 <= top + BRICK_HEIGHT * scale + 0.5
    # All of the brick is gone, but for the mortar around it.
    assert len(rows) >= 0.8 * BRICK_WIDTH * BRICK_HEIGHT * scale**2 - 2 * (scale + 1)


def brick_pictures(height: int, width: int) -> list[NDArray[np.int64]]:
    """The greyscale pixels of the same cell with a brick of each kind."""
    batch = new_game()
    pictures = []
    view = make_view(height, width)[0]
    batch.worlds[0].brick_hits[:] = 0
    for kind in range(1, GOLD + 1):
        batch.worlds["kind"] = kind
        batch.worlds[0].brick_hits[60] = UNBREAKABLE if kind == GOLD else 2
        grey = picture(batch, height, width) @ LUMA
        rows, columns = view.rows[5:7], view.columns[5:7]
        pictures.append(grey[rows[0] : rows[1], columns[0] : columns[1]].astype(np.int64))
    return pictures


@pytest.mark.parametrize("size", SIZES)
def test_all_kinds_of_bricks_differ_in_greyscale(size: tuple[int, int]) -> None:
    pictures = brick_pictures(*size)
    for index, one in enumerate(pictures):
        for other in pictures[index + 1 :]:
            # The bodies of the colours are 20 apart, and 0.82 times that at their feet.
            assert np.abs(one - other).max() >= 16


def test_the_brick_colours_are_steps_of_one_ladder_of_brightness() -> None:
    colours = PALETTE[BRICK + 1 : BRICK + 1 + COLOURS]
    assert np.diff(np.sort(colours @ LUMA)).min() >= 20


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("round_number", [1, 9, 17, 2000])
def test_silver_shows_its_damage_and_gold_has_none(
    size: tuple[int, int], round_number: int
) -> None:
    batch = new_game()
    world = batch.worlds[0]
    world.round_number = round_number
    batch.worlds["kind"] = SILVER
    needed = min(2 + (round_number - 1) // 8, UNBREAKABLE - 1)
    looks = []
    for hits in range(needed, 0, -1):
        world.brick_hits[:] = hits
        looks.append(hashlib.sha256(picture(batch, *size)).hexdigest())
    assert looks[0] not in looks[1:]
    # Damage is shown in three steps, each of which is seen once there are so many hits.
    assert len(set(looks[1:])) == min(needed - 1, 3)
    batch.worlds["kind"] = GOLD
    world.brick_hits[:] = UNBREAKABLE
    assert hashlib.sha256(picture(batch, *size)).hexdigest() not in looks


@pytest.mark.parametrize(
    ("name", "value"), [("score", 1234567), ("round_number", 42), ("lives", 2)]
)
def test_the_score_line_shows_numbers_above_the_field_only(name: str, value: int) -> None:
    batch = new_game()
    before = picture(batch)
    batch.worlds[0][name] = value
    rows = np.nonzero(changed(before, picture(batch)))[0]
    assert len(rows) > 0
    assert rows.max() < place(512, 384, 0.0, FIELD_HEIGHT + 0.5)[1]


@pytest.mark.parametrize("lives", range(6))
def test_lives_are_counted_in_small_paddles(lives: int) -> None:
    batch = new_game()
    batch.worlds[0].lives = 0
    none = picture(batch)
    batch.worlds[0].lives = lives
    columns = changed(none, picture(batch)).any(axis=0).astype(int)
    assert (np.diff(columns) == 1).sum() == lives


@pytest.mark.parametrize("score", [10**15, 2**63 - 1])
def test_a_huge_score_stays_off_the_rounds_number(score: int) -> None:
    batch = new_game()
    before = picture(batch)
    batch.worlds[0].score = score
    columns = np.nonzero(changed(before, picture(batch)))[1]
    assert columns.max() < place(512, 384, 4.6, 0.0)[0]


def test_a_wide_paddle_of_the_rules_is_drawn_wide() -> None:
    widths = []
    for factor in (1.0, 1.5):
        batch = new_game(paddle=factor)
        batch.worlds[0].ball_state[0] = ABSENT
        here = picture(batch)
        batch.worlds[0].paddle_x = -9.0
        columns = np.nonzero(changed(here, picture(batch)))[1]
        widths.append(columns.max() + 1 - columns.min())
    assert widths == [64, 96]
