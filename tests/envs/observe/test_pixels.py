"""The observation `rgb`: the pictures that are rendered, in grey and stacked, too."""

import hashlib

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.draw.palette import LUMA
from arkanoid.envs.draw.picture import draw_world
from helpers.plays import EVERYTHING, play


@pytest.mark.parametrize("size", [84, (84, 84), [60, 100], (210, 160), 7])
def test_channels_are_those_of_rendered_pictures(size):
    env = ArkanoidEnv(observation="rgb", size=size, **EVERYTHING)
    height, width = (size, size) if isinstance(size, int) else size
    assert env.observation_space.shape == (3, height, width)
    for observation in play(env, 150):
        # The world is unchanged since it was observed, but for one that has been reset.
        picture = draw_world(env._batch.worlds, env._batch.rules, 0, height, width)
        assert observation.dtype == np.uint8
        assert (observation == picture.transpose(2, 0, 1)).all()
        for channel, name in enumerate(("red", "green", "blue")):
            assert (observation[env.layout[name]] == picture[np.newaxis, :, :, channel]).all()


def test_grey_is_the_brightness():
    grey = ArkanoidEnv(observation="rgb", grey=True, **EVERYTHING)
    colour = ArkanoidEnv(observation="rgb", **EVERYTHING)
    assert grey.observation_space.shape == (1, 84, 84)
    for one, three in zip(play(grey, 200), play(colour, 200), strict=True):
        brightness = np.tensordot(LUMA, three.astype(float), 1)
        # Each layer that is mixed into a pixel is rounded: by up to a half, in either picture.
        assert np.abs(one[0] - brightness).max() <= 2.5


@pytest.mark.parametrize(("grey", "stack"), [(True, 2), (True, 4), (False, 3)])
def test_stacks_hold_the_latest_pictures_in_order(grey, stack):
    keywords = EVERYTHING | {"observation": "rgb", "grey": grey, "size": 42}
    stacked, plain = ArkanoidEnv(stack=stack, **keywords), ArkanoidEnv(**keywords)
    channels = 1 if grey else 3
    assert stacked.observation_space.shape == (stack * channels, 42, 42)
    stacked.action_space.seed(1)
    for episode in range(3):
        pictures = [plain.reset(seed=episode)[0]] * stack
        shown, over = stacked.reset(seed=episode)[0], False
        while not over:
            assert (shown == np.concatenate(pictures)).all()
            assert (shown[stacked.layout["oldest"]] == pictures[0]).all()
            assert (shown[stacked.layout["newest"]] == pictures[-1]).all()
            if not grey:
                assert (shown[stacked.layout["green"]] == [each[1] for each in pictures]).all()
            action = stacked.action_space.sample()
            shown, _, terminated, truncated, _ = stacked.step(action)
            pictures = [*pictures[1:], plain.step(action)[0]]
            over = terminated or truncated


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_a_stack_forgets_the_episode_before(mode):
    env = ArkanoidVectorEnv(
        4, autoreset_mode=mode, observation="rgb", grey=True, stack=4, size=30, max_decisions=11
    )
    env.reset(seed=0)
    env.action_space.seed(0)
    begun = 0
    for _ in range(100):
        shown, _, _, truncated, infos = env.step(env.action_space.sample())
        for world in np.flatnonzero(env.state["decisions"] == 0):
            begun += 1
            assert (shown[world] == shown[world, -1]).all()
            if mode == "SameStep":
                assert truncated[world]
                assert not (infos["final_obs"][world] == infos["final_obs"][world][-1]).all()
    assert begun >= 4 * 7


def test_pictures_that_are_kept_are_not_overwritten():
    env = ArkanoidVectorEnv(2, observation="rgb", stack=4, size=30)
    kept = [env.reset(seed=0)[0]]
    digests = [hashlib.sha256(kept[0].tobytes()).digest()]
    for _ in range(40):
        kept.append(env.step(env.action_space.sample())[0])
        digests.append(hashlib.sha256(kept[-1].tobytes()).digest())
    assert [hashlib.sha256(one.tobytes()).digest() for one in kept] == digests
    assert all(one.flags.c_contiguous for one in kept)
