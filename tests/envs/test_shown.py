"""How an environment shows itself in a notebook."""

from typing import Any

import gymnasium as gym
import imageio.v3 as iio
import numpy as np


def test_an_environment_says_what_is_different_and_how_far_it_is() -> None:
    env: Any = gym.make("arkanoid:Arkanoid-v0", lives=5, render_mode="rgb_array", render_size=64)
    assert repr(env.unwrapped) == "<ArkanoidEnv(lives=5): not reset yet>"
    assert env.unwrapped._repr_png_() is None
    env.reset(seed=1)
    assert repr(env.unwrapped) == "<ArkanoidEnv(lives=5): round 1, score 0, lives 5>"
    picture = iio.imread(env.unwrapped._repr_png_())
    np.testing.assert_array_equal(picture, env.render())
    env.close()
