"""Whole pictures: any size, the same bits everywhere, and updated as if drawn afresh."""

import numpy as np
import pytest
from arkanoid.envs.batch.batch import Batch
from arkanoid.envs.config import Config
from arkanoid.envs.draw.canvas import Drawn
from arkanoid.envs.draw.frame import draw_frame
from arkanoid.envs.draw.palette import LUMA
from arkanoid.envs.draw.picture import draw_world
from arkanoid.envs.draw.scenery import make_scenery
from arkanoid.envs.draw.view import FULL_HEIGHT, FULL_WIDTH, HEADER_SCALE, make_view
from arkanoid.envs.rules import (
    FIELD_HEIGHT,
    FIELD_WIDTH,
    MAX_ENEMIES,
)
from helpers.pictures import PROPERTY, SIZES, empty_game, new_game, picture, random_scene, to_pixels
from helpers.processes import COMPILED, INTERPRETED, run_program
from hypothesis import given
from hypothesis import strategies as st


def test_the_default_picture_has_32_pixels_per_brick() -> None:
    frame = picture(new_game())
    assert frame.shape == (512, 384, 3)
    assert frame.dtype == np.uint8
    assert make_view(512, 384)[0].scale == 32.0
    assert to_pixels(512, 384, 0.0, 0.0) == (16.0, 512.0)


@PROPERTY
@given(height=st.integers(1, 400), width=st.integers(1, 400))
def test_the_field_fits_any_size_and_is_centred(height: int, width: int) -> None:
    view = make_view(height, width)[0]
    left, right = (
        to_pixels(height, width, 0.0, 0.0)[0],
        to_pixels(height, width, FIELD_WIDTH, 0.0)[0],
    )
    bottom, top = (
        to_pixels(height, width, 0.0, 0.0)[1],
        to_pixels(height, width, 0.0, FIELD_HEIGHT)[1],
    )
    # The field begins at a whole pixel.
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
    first[:] = 7  # the array belongs to the caller
    second = picture(batch, *size)
    np.testing.assert_array_equal(second, kept)
    np.testing.assert_array_equal(batch.worlds, before)


# Draws a game that has one of everything.
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
    printed = [run_program(SCRIPT, changes=mode).stdout for mode in (COMPILED, INTERPRETED)]
    assert len(set(printed[0].split())) == 6
    assert printed[0] == printed[1]


class Canvas:
    """A picture that is kept up to date."""

    def __init__(self, height: int, width: int, channels: int) -> None:
        self.scenery = make_scenery(height, width, channels)
        self.picture = np.full((height, width, channels), 77, np.uint8)
        self.lines = self.picture.reshape(height, -1)
        self.drawn = np.zeros(1, Drawn)

    def draw(self, batch: Batch, index: int = 0) -> None:
        world, rules = batch.worlds[index], batch.rules[0]
        draw_frame(self.picture, self.lines, self.drawn[0], self.scenery, world, rules)


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
def test_an_updated_picture_equals_a_fresh_one(
    size: tuple[int, int, int],
) -> None:
    """Bit for bit, whatever the picture showed before: so it is enough to draw the differences."""
    batch, canvas, random = new_game(), Canvas(*size), np.random.default_rng(size)
    for _ in range(60):
        random_scene(batch, random)
        canvas.draw(batch)
        np.testing.assert_array_equal(canvas.picture, picture(batch, *size))


def test_updated_pictures_of_games_in_play_equal_fresh_ones() -> None:
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
        # Each layer is rounded to a whole number, in both pictures by half a step at most. No pixel
        # has more than ten layers: field, gate, boss (rim, body, face, stroke), enemy and eye.
        assert np.abs(grey - picture(batch, *size) @ LUMA).max() <= 10


def test_nothing_is_drawn_below_the_field_or_above_the_ceiling() -> None:
    """Enemies come from above the ceiling, and balls and capsules fall below the field."""
    height, width = 400, 100
    batch, random = new_game(), np.random.default_rng(7)
    empty = picture(empty_game(), height, width)
    bottom = round(to_pixels(height, width, 0.0, 0.0)[1])
    top = to_pixels(height, width, 0.0, FIELD_HEIGHT + 0.5)[1]
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
