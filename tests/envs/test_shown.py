"""How an environment shows itself in a notebook."""

from typing import Any

import gymnasium as gym
import imageio.v3 as iio
import numpy as np
import pytest
from arkanoid.envs.vector_env import ArkanoidVectorEnv


def test_an_environment_says_what_is_different_and_how_far_it_is() -> None:
    env: Any = gym.make("arkanoid:Arkanoid-v0", lives=5, render_mode="rgb_array", render_size=64)
    assert repr(env.unwrapped) == "<ArkanoidEnv(lives=5): not reset yet>"
    assert env.unwrapped._repr_png_() is None
    env.reset(seed=1)
    assert repr(env.unwrapped) == "<ArkanoidEnv(lives=5): round 1, score 0, lives 5>"
    picture = iio.imread(env.unwrapped._repr_png_())
    np.testing.assert_array_equal(picture, env.render())
    env.close()


def test_a_vector_environment_says_how_far_its_worlds_are() -> None:
    """It said ``ArkanoidVectorEnv(num_envs=3)``, and notebooks showed no picture."""
    envs: Any = ArkanoidVectorEnv(3, lives=5, render_mode="rgb_array")
    assert repr(envs) == "<ArkanoidVectorEnv(num_envs=3, lives=5): not reset yet>"
    assert envs._repr_png_() is None
    mask = np.array([True, True, False])
    envs.reset(seed=1, options={"reset_mask": mask})
    assert "not reset yet" in repr(envs)
    envs.reset(seed=1)
    for _ in range(60):
        infos = envs.step(np.array([3, 4, 5]))[-1]
    spans = [f"{name} {min(infos[name])} to {max(infos[name])}" for name in ("score", "lives")]
    assert all(len(set(infos[name])) > 1 for name in ("score", "lives"))
    start = "<ArkanoidVectorEnv(num_envs=3, lives=5): round 1, "
    assert repr(envs) == f"{start}{', '.join(spans)}>"
    envs.close()


@pytest.mark.parametrize(("worlds", "rows", "columns"), [(2, 1, 2), (7, 3, 3), (40, 4, 4)])
def test_a_vector_environment_shows_its_first_worlds(worlds: int, rows: int, columns: int) -> None:
    height = 512 // rows
    size = {"render_mode": "rgb_array", "render_size": height}
    envs: Any = ArkanoidVectorEnv(worlds, levels="train", **size)
    envs.reset(seed=1)
    sheet = iio.imread(envs._repr_png_())
    frames = envs.render()
    width = frames[0].shape[1]
    assert sheet.shape == (rows * (height + 8) - 8, columns * (width + 8) - 8, 3)
    for index in range(rows * columns):
        top, left = index // columns * (height + 8), index % columns * (width + 8)
        tile = sheet[top : top + height, left : left + width]
        np.testing.assert_array_equal(tile, frames[index] if index < worlds else 255)
    assert (sheet[:, width : width + 8] == 255).all()
    envs.close()


def test_a_vector_environment_of_one_world_shows_it_in_its_size() -> None:
    envs: Any = ArkanoidVectorEnv(1, render_mode="rgb_array", render_size=64)
    envs.reset(seed=1)
    np.testing.assert_array_equal(iio.imread(envs._repr_png_()), envs.render()[0])
    envs.close()
