"""The status in small pictures: what their players must know, and can read from the pixels."""

from fractions import Fraction

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv
from arkanoid.envs.draw.picture import draw_world
from arkanoid.envs.draw.status import status_layout
from helpers.pictures import new_game, picture, random_scene
from numpy.typing import NDArray

SMALL = [(84, 84), (42, 42), (84, 70), (120, 90), (60, 100)]
# As documented: the line, the first unit and the number of units of each part.
UNITS = {"idle_clock": (0, 0, 6), "decision_clock": (0, 6, 6)}
UNITS |= {"lives": (0, 12, 4), "round": (0, 16, 6), "score": (1, 0, 22)}


def read(shown: NDArray[np.uint8]) -> dict[str, float]:
    """Read the status of a grey picture, uint8 [height, width]: bars in [0, 1], and numbers."""
    values: dict[str, float] = {}
    for name, (rows, columns) in status_layout(*shown.shape).items():
        pixels = shown[rows, columns].astype(int)
        assert (pixels == pixels[0]).all(), "all rows of a line are the same"
        units = UNITS[name][2]
        if name.endswith("clock"):
            values[name] = (pixels[0] - 4).sum() / (142 - 4) / len(pixels[0])
        else:
            middles = [int(len(pixels[0]) * (unit + 0.5) / units) for unit in range(units)]
            bits = "".join(str(int(pixels[0, middle] > 80)) for middle in middles)
            values[name] = int(bits, 2)
    return values


def test_at_84_by_84_each_unit_is_three_pixels() -> None:
    layout = status_layout(84, 84)
    assert list(layout) == list(UNITS)
    for name, (line, first, units) in UNITS.items():
        left, top = 9 + 3 * first, 78 + 3 * line
        assert layout[name] == (slice(top, top + 3), slice(left, left + 3 * units))


def test_pictures_with_a_score_line_have_no_status() -> None:
    assert status_layout(512, 384) == {}


@pytest.mark.parametrize("size", SMALL)
def test_the_status_can_be_read(size: tuple[int, int]) -> None:
    """Score, lives, round and clocks were not to be seen, though two of them end an episode."""
    batch, random = new_game(), np.random.default_rng(size)
    world = batch.worlds[0]
    for _ in range(100):
        random_scene(batch, random)
        world.score = 10 * random.integers(0, 10 ** random.integers(1, 7))
        world.lives, world.round_number = random.integers(0, 16), random.integers(1, 64)
        values = read(picture(batch, *size, 1)[:, :, 0])
        assert values["score"] * 10 == world.score
        assert (values["lives"], values["round"]) == (world.lives, world.round_number)
        # Of the 138 steps of a pixel, rounding takes a half, and so does that of the bar's colour.
        width = 6 * 0.5 * min(size[0] / 14, size[1] / 12)
        step = 1 / 138 / (width - 1)
        assert values["idle_clock"] == pytest.approx(
            float(Fraction(int(world.idle), 3600)), abs=step
        )
        decided = float(Fraction(int(world.decisions), 27_000))
        assert values["decision_clock"] == pytest.approx(decided, abs=step)


def test_numbers_that_are_too_large_show_ones_only() -> None:
    batch = new_game()
    world = batch.worlds[0]
    world.score, world.lives, world.round_number = 10**9, 1000, 64
    values = read(picture(batch, 84, 84, 1)[:, :, 0])
    assert values["score"] == 2**22 - 1
    assert (values["lives"], values["round"]) == (15, 63)


@pytest.mark.parametrize("size", SMALL)
def test_nothing_is_drawn_over_the_status(size: tuple[int, int]) -> None:
    batch, random = new_game(), np.random.default_rng(1)
    world = batch.worlds[0]
    rows = slice(status_layout(*size)["idle_clock"][0].start, None)
    expected = None
    for _ in range(100):
        random_scene(batch, random)
        batch.worlds["ball_y"] = batch.worlds["enemy_y"] = 0.4
        world.capsule_y = 0.7
        world.score, world.lives, world.round_number = 70, 3, 1
        world.idle = world.decisions = 0
        shown = picture(batch, *size)[rows]
        expected = shown if expected is None else expected
        assert (shown == expected).all()


def test_an_observation_shows_the_status_of_its_game() -> None:
    env = ArkanoidEnv(observation="rgb", grey=True, max_decisions=500)
    observation, _ = env.reset(seed=0)
    env.action_space.seed(0)
    over = False
    while not over:
        values = read(observation[0])
        world = env.state
        assert values["score"] * 10 == world["score"]
        assert (values["lives"], values["round"]) == (world["lives"], world["round_number"])
        assert values["decision_clock"] == pytest.approx(int(world["decisions"]) / 500, abs=1e-3)
        observation, _, terminated, truncated, _ = env.step(env.action_space.sample())
        over = terminated or truncated
    assert (
        observation[0] == draw_world(env._batch.worlds, env._batch.rules, 0, 84, 84, 1)[..., 0]
    ).all()
