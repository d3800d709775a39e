"""Grounds of many tiles: whatever slides, falls, walks or jumps there, feels no seam.

A box that slid along a row of boxes met the side of the next one, if rounding let it overlap the
row by the last digit: it stopped, turned or flew back. Here the same ground in few large colliders
says what is right, or the velocity, which must not change.
"""

import math
from itertools import product

import numpy as np
import pytest
from arkanoid.physics import (
    AxisAlignedRectangle,
    Body,
    Collider,
    Particle,
    World,
)
from helpers.grounds import (
    CORNERS,
    FORMS,
    KINDS,
    Frame,
    Rng,
    decimal,
    drop,
    random_frame,
    random_mover,
)

UNIT_ROUNDOFF = 2.0**-53


@pytest.mark.parametrize("form", ["box", "rectangle", "convex"])
def test_a_box_slides_along_a_row_of_boxes(form: str) -> None:
    """In 20 of these 81 scenes it flew back; in 29 it turned, if it was no axis-aligned box."""
    frame = Frame()
    for below, above in product(range(1, 10), repeat=2):
        tile, height = below / 10, above / 10
        row = [frame.block(form, i, tile / 2, 1, tile) for i in range(6)]
        box = frame.block(form, 0, tile + height / 2, 0.5, height)
        world = World([*row, Body(box.collider, box.position, (1, 0), mass=1)])
        assert len(world.step(5.0)) == 0
        assert world.velocities[-1].tolist() == [1, 0]


def check_slides(seed: int, kind: str, is_level: bool, count: int) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(count):
        frame, form = random_frame(rng, is_level), str(rng.choice(FORMS))
        width, height = decimal(rng, 0.3, 2), decimal(rng, 0.2, 1)
        x, y = decimal(rng, -20, 20), decimal(rng, -20, 20)
        row = [frame.block(form, x + i * width, y, width, height) for i in range(8)]
        shape = random_mover(rng, kind, frame.angle)
        start, speed = float(rng.uniform(0, 1)) * width, decimal(rng, 0.5, 9)
        if rng.random() < 0.5:
            start, speed = 7 * width - start, -speed
        place = frame.turn(x + start, y + height / 2 + drop(shape, frame))
        restitution = float(rng.choice([0, 1]))
        world = World([*row, Body(shape, place, frame.turn(speed, 0), 1, restitution)])
        before = world.velocities[-1]
        steps = int(rng.choice([1, 60]))
        hits = world.step(7 * width / abs(speed) / steps, steps=steps)
        turn = math.dist(world.velocities[-1], before) / abs(speed)
        if is_level:
            assert (len(hits), turn) == (0, 0)
        # A slanted side made of corners is turned by their rounding over its length; two sides,
        # and a bounce doubles it.
        assert turn <= 16 * UNIT_ROUNDOFF * (abs(x) + abs(y) + 8 * width) / width


@pytest.mark.parametrize("is_level", [True, False])
@pytest.mark.parametrize("kind", KINDS)
def test_nothing_that_slides_meets_a_seam(kind: str, is_level: bool) -> None:
    """Of 300 slides down a ramp of rotated tiles, 235 changed their course."""
    check_slides(1, kind, is_level, 60)


@pytest.mark.slow
@pytest.mark.parametrize("is_level", [True, False])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(10, 15))
def test_nothing_that_slides_meets_a_seam_at_length(kind: str, is_level: bool, seed: int) -> None:
    check_slides(seed, kind, is_level, 1000)


def test_a_box_rides_on_a_row_of_tiles_that_moves() -> None:
    """Each tile's position is rounded by itself, in every step."""
    rng = np.random.default_rng(3)
    for kind in KINDS:
        for _ in range(20):
            shape, drift = random_mover(rng, kind, 0.0), rng.uniform(-2, 2, 2)
            row = [Body(AxisAlignedRectangle(0.7, 0.3), (0.7 * i, 0), drift) for i in range(9)]
            place = (1 + float(rng.uniform()), 0.15 + drop(shape, Frame()))
            world = World([*row, Body(shape, place, drift + np.array([1.3, 0]), mass=1)])
            before = world.velocities[-1].tolist()
            assert len(world.step(1 / 37, steps=90)) == 0
            assert world.velocities[-1].tolist() == before


def check_landings(seed: int, kind: str, count: int, far: float = 20) -> None:
    """Let shapes come down on a row of tiles and on one wall, often almost along it or at seams.

    Coordinates are up to ``far``. What lands just at a seam shall not see where a tile ends.
    """
    rng = np.random.default_rng(seed)
    for _ in range(count):
        frame, form = random_frame(rng, rng.random() < 0.5), str(rng.choice(FORMS))
        width, height = decimal(rng, 0.3, 2), decimal(rng, 0.2, 1)
        x, y = decimal(rng, -far, far), decimal(rng, -far, far)
        shape, speed = random_mover(rng, kind, frame.angle), decimal(rng, 0.5, 5)
        slope, gap = (
            10 ** rng.uniform(-12, 0.3),
            float(rng.choice([0.0, 10 ** rng.uniform(-16, 0)])),
        )
        start = rng.uniform(2, 4) * width
        if rng.random() < 0.3 and gap / slope < width:
            start = 2.5 * width - gap / slope + float(rng.choice([0, 1e-9, -1e-9, 1e-12, -1e-12]))
        place = frame.turn(x + start, y + height / 2 + drop(shape, frame) + gap)
        body = Body(shape, place, frame.turn(speed, -speed * slope), 1)
        row = [frame.block(form, x + i * width, y, width, height) for i in range(12)]
        wall = frame.block(form, x + 5.5 * width, y, 12 * width, height)
        tiles, whole = World([*row, body]), World([wall, body])
        for world in (tiles, whole):
            world.step(4 * width / speed)
        turn = math.dist(tiles.velocities[-1], whole.velocities[-1]) / speed
        assert turn <= 16 * UNIT_ROUNDOFF * (abs(x) + abs(y) + 12 * width) / width


@pytest.mark.parametrize("kind", KINDS)
def test_what_lands_on_tiles_bounces_as_off_one_wall(kind: str) -> None:
    check_landings(3, kind, 200)


@pytest.mark.parametrize("far", [1e3, 1e6])
@pytest.mark.parametrize("kind", KINDS)
def test_what_lands_on_tiles_far_out_bounces_as_off_one_wall(kind: str, far: float) -> None:
    check_landings(3, kind, 100, far)


@pytest.mark.slow
@pytest.mark.parametrize("far", [20, 1e3, 1e6])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(30, 34))
def test_what_lands_on_tiles_bounces_as_off_one_wall_at_length(
    kind: str, seed: int, far: float
) -> None:
    check_landings(seed, kind, 1000, far)


@pytest.mark.parametrize(("shape", "reach"), CORNERS)
@pytest.mark.parametrize("x", [0.0, 1000.0, 1e5, 1e6])
def test_a_corner_that_lands_on_a_seam_meets_the_ground(
    shape: Collider, reach: float, x: float
) -> None:
    """It caught there with 10 000 hits, turned aside, or fell through, as a point did.

    The two tiles each took it for an end of the ground. Now they see that it goes on.
    """
    rng = np.random.default_rng(8)
    for vx, vy, high, restitution in product((0, 0.1, -1, 3), (1e-6, 0.1, 1, 2), (0, 0.3), (0, 1)):
        offset = float(rng.choice([-1, 0, 1])) * 10 ** rng.uniform(-17, -9)
        time = high / vy
        row = [Body(AxisAlignedRectangle(1, 0.2), (x + i, 0.1)) for i in range(-4, 5)]
        place = (x + 0.5 + offset - vx * time, 0.2 + reach + high)
        if abs(vx) * (time + 0.5) > 3:
            continue
        tiles = [row[i] for i in rng.permutation(len(row))]
        world = World([*tiles, Body(shape, place, (vx, -vy), 1, restitution)])
        (hit,) = world.step(time + 0.5)
        assert hit["normal"].tolist() == [0, 1]
        assert world.velocities[-1].tolist() == [vx, restitution * vy]
        assert abs(hit["time"] - time) * vy <= 1e-12 * (1 + reach)


@pytest.mark.parametrize(("shape", "reach"), CORNERS)
def test_at_an_end_of_the_ground_a_corner_may_pass(shape: Collider, reach: float) -> None:
    """What falls beside a stack of boxes, or leaves it, does not meet their ends."""
    stack = [Body(AxisAlignedRectangle(1, 0.2), (0, 0.2 * i)) for i in range(9)]
    half = max(edge.start_x for edge in shape.edges) if shape.edges else 0.0
    beside = Body(shape, (0.5 + half, 3), (0, -2), mass=1)
    assert len(World([*stack, beside]).step(2.0)) == 0
    over = Body(shape, (-1, 1.7 + reach), (1, 0), mass=1)
    assert len(World([*stack, over]).step(3.0)) == 0


# A platformer: gravity, walking, jumping, walls.


def columns(rng: Rng) -> list[int]:
    """Return how many tiles are stacked in each column, with a wall at either end."""
    middle = rng.choice(3)
    heights = np.ones(10, np.int64)
    if middle == 1:
        heights = np.clip(np.cumsum(rng.integers(-1, 2, 10)) + 3, 1, 8)
    elif middle == 2:
        heights = rng.choice([1, 1, 1, 6], 10)
    return [9, *heights.tolist(), 9]


def tiled(frame: Frame, form: str, heights: list[int], grid: tuple[float, ...]) -> list[Body]:
    """Return the ground, a block for each tile; the grid is (x, y, width, height)."""
    x, y, width, height = grid
    return [
        frame.block(form, x + column * width, y + row * height, width, height)
        for column, count in enumerate(heights)
        for row in range(count)
    ]


def joined(frame: Frame, form: str, heights: list[int], grid: tuple[float, ...]) -> list[Body]:
    """Return the same ground: for each level, blocks from the bottom up to there, without seams."""
    x, y, width, height = grid
    blocks = []
    for level in range(1, max(heights) + 1):
        column = 0
        while column < len(heights):
            first = column
            while column < len(heights) and heights[column] >= level:
                column += 1
            if column > first:
                middle = x + (first + column - 1) / 2 * width, y + (level - 1) / 2 * height
                size = (column - first) * width, level * height
                blocks.append(frame.block(form, *middle, *size))
            column += 1
    return blocks


def check_walks(seed: int, kind: str, count: int, far: float = 20) -> None:
    """Compare both grounds, frame by frame, under a player who walks, turns and jumps.

    Coordinates are up to ``far``, and so many roundings are hidden.
    """
    rng = np.random.default_rng(seed)
    dt = 0.0161803  # of a frame; a round number would let bodies land just as a frame ends
    for _ in range(count):
        frame, form = random_frame(rng, rng.random() < 0.5), str(rng.choice(FORMS))
        x, y = decimal(rng, -far, far), decimal(rng, -far, far)
        grid = (x, y, decimal(rng, 0.3, 1.5), decimal(rng, 0.3, 1))
        heights = columns(rng)
        shape, restitution = random_mover(rng, kind, frame.angle), float(rng.choice([0, 0, 0.5, 1]))
        column = float(rng.choice([rng.uniform(2, 9), rng.integers(4, 18) / 2]))
        place = (x + column * grid[2], y + 10 * grid[3] + 1)
        player = Body(shape, frame.turn(*place), (0, 0), 1, restitution)
        worlds = [
            World([*(blocks[i] for i in rng.permutation(len(blocks))), player])
            for blocks in (
                tiled(frame, form, heights, grid),
                joined(frame, form, heights, grid),
            )
        ]
        walk = 0.0
        for number in range(200):
            if rng.random() < 0.05:
                walk = float(rng.uniform(-4, 4))
            jump = 5.0 if rng.random() < 0.02 else 0.0
            places = []
            for world in worlds:
                vx, vy = frame.back(*world.velocities[-1])
                # What bounces is pushed only now and then.
                vx = walk if restitution == 0 or number % 20 == 0 else vx
                world.place(len(world) - 1, velocity=frame.turn(vx, vy - 9.7 * dt + jump))
                world.step(dt)
                assert world.capped == 0
                places.append([*world.positions[-1], *world.velocities[-1]])
            np.testing.assert_allclose(places[0], places[1], rtol=0, atol=5e-10 * far)


@pytest.mark.parametrize("kind", KINDS)
def test_tiles_are_walked_over_like_one_ground(kind: str) -> None:
    """Of 300 falls along a wall of tiles, pressed into it, 100 hung in mid-air."""
    check_walks(2, kind, 8)


@pytest.mark.parametrize("far", [1e3, 1e5, 1e6])
@pytest.mark.parametrize("kind", KINDS)
def test_tiles_are_walked_over_like_one_ground_far_out(kind: str, far: float) -> None:
    """A box pressed into a wall fell through the floor, where tiles were buried under others.

    Of a floor and a wall that it touched, the wall was met first, although only by rounding and
    much later; until then nothing stopped its fall. Corners and points caught at seams.
    """
    check_walks(5, kind, 8, far)


@pytest.mark.slow
@pytest.mark.parametrize("far", [20, 1e3, 1e5, 1e6])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(20, 24))
def test_tiles_are_walked_over_like_one_ground_at_length(kind: str, seed: int, far: float) -> None:
    check_walks(seed, kind, 100, far)


def test_a_box_that_lands_on_a_seam_keeps_its_speed_along_the_row() -> None:
    """Steeply falling, with its corner on the seam, it met the side of the next tile."""
    for vx, vy, offset in product(
        (0.5, 1.0, 3.0, -0.5), (-0.25, -1.0, -2.0), (0.0, 1e-15, -1e-15, 1e-13, -1e-13)
    ):
        row = [Body(AxisAlignedRectangle(0.7, 0.2), (0.7 * i, 0.1)) for i in range(-9, 9)]
        # In one unit of time it falls by |vy|; then its front corner is at the seam x = 0.35.
        front = 0.15 if vx > 0 else -0.15
        place = (0.35 - front - vx + offset, 0.2 + 0.15 - vy)
        for bodies in (row, row[::-1]):
            world = World([*bodies, Body(AxisAlignedRectangle(0.3, 0.3), place, (vx, vy), mass=1)])
            (hit,) = world.step(1.5)
            assert hit["normal"].tolist() == [0, 1]
            assert world.velocities[-1].tolist() == [vx, -vy]


def test_an_inelastic_disc_rolls_over_a_corner() -> None:
    """It met the corner again and again, by rounding, and each time lost 1e-7 of its speed."""
    rng = np.random.default_rng(4)
    for _ in range(300):
        corner, radius = rng.uniform(-20, 20, 2), float(rng.uniform(0.1, 1))
        toward = rng.uniform(0.05, math.pi / 2 - 0.05)  # where on the disc the corner is met
        out = np.array([math.cos(toward), math.sin(toward)])
        aside = np.array([-out[1], out[0]]) * float(rng.uniform(-1, 1))
        velocity = -out + aside
        box = Body(AxisAlignedRectangle(2, 2), corner - 1)
        world = World(
            [box, Body(Particle(radius), corner + radius * out - 0.1 * velocity, velocity, 1, 0)]
        )
        (hit,) = world.step(0.1 + 1e-9)
        assert hit["normal"] == pytest.approx(out, abs=1e-12)
        assert len(world.step(1e-6, steps=3)) == 0
        assert world.velocities[-1] == pytest.approx(aside, abs=1e-12)
