"""Landings among the walls alone: as numbers, as a baseline, as features of a network."""

from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
import torch
from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.experiment.settings import load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.learn.landing import EXTRA, LATEST, TICKS, LandingExtractor
from arkanoid.agents.learn.model import load_policy
from arkanoid.agents.learn.networks import extractor_arguments
from arkanoid.agents.learn.training import train
from arkanoid.agents.measure.baselines import LandingFollower, make_baseline
from arkanoid.agents.measure.episodes import play_episodes
from arkanoid.agents.measure.landing import fastest_ball, landings, next_ball
from arkanoid.agents.measure.suites import find_starts
from arkanoid.envs import ArkanoidVectorEnv
from arkanoid.envs.observe.landing import LANDING_TICKS
from arkanoid.envs.rules import BALL_RADIUS, FIELD_HEIGHT, FIELD_WIDTH, PADDLE_TOP
from arkanoid.envs.state import ABSENT, FLYING, HELD
from helpers.runs import small
from helpers.states import observe_anew, writable_states
from stable_baselines3 import PPO

THREE = gym.spaces.Discrete(3)
NO_OP, LEFT, RIGHT = 0, 1, 2
WORLDS = 500


def empty_fields(speed: float) -> ArkanoidVectorEnv:
    """Return worlds without bricks, with three balls each that fly anywhere at the game's speed."""
    env = ArkanoidVectorEnv(WORLDS, speed=speed, landing=True, levels="seeds:0-9")
    env.reset(seed=0)
    worlds, generator = writable_states(env), np.random.default_rng(0)
    worlds["brick_hits"] = 0
    worlds["ball_state"] = FLYING
    worlds["speed_stage"] = generator.integers(1, 8, WORLDS)
    worlds["ball_x"] = generator.uniform(BALL_RADIUS, FIELD_WIDTH - BALL_RADIUS, (WORLDS, 3))
    worlds["ball_y"] = generator.uniform(PADDLE_TOP + 0.2, FIELD_HEIGHT - 0.2, (WORLDS, 3))
    angles = generator.uniform(0.2, np.pi - 0.2, (WORLDS, 3))
    signs = generator.choice([-1.0, 1.0], (WORLDS, 3))
    fast = 0.176 * speed * (1 + 0.25 * worlds["speed_stage"])[:, np.newaxis]
    worlds["ball_vx"], worlds["ball_vy"] = fast * np.cos(angles), signs * fast * np.sin(angles)
    return env


@pytest.mark.parametrize("speed", [0.5, 1.0, 4.0])
def test_in_an_empty_field_they_are_what_the_game_says(speed: float) -> None:
    """The game's own flight is another program, from impact to impact."""
    env = empty_fields(speed)
    seen, layout = observe_anew(env).astype(np.float64), env.layout
    assert (seen[:, layout["landing_known"]] == 1).all()
    found = landings(seen, layout, fastest_ball(speed))
    assert (found.falls != found.rises).all()
    x = (seen[:, layout["landing_x"]] + 1) * (FIELD_WIDTH / 2)
    ticks = seen[:, layout["landing_ticks"]] * LANDING_TICKS
    assert (ticks < LANDING_TICKS).mean() > 0.9
    # Observations are float32: positions are off by some 1e-7, and the flat ways are long.
    np.testing.assert_allclose(found.x, x, atol=1e-4)
    np.testing.assert_allclose(np.minimum(found.time, LANDING_TICKS), ticks, rtol=1e-4, atol=1e-3)


def layout_and_extractor(speed: float = 1.0) -> tuple[dict[str, slice], LandingExtractor]:
    experiment = load_experiment(
        "quick",
        [("network.features", "landing"), ("env.landing", "false"), ("env.speed", str(speed))],
    )
    env = ArkanoidVectorEnv(1, **experiment.config.plain())
    made = extractor_arguments(experiment.network, experiment.config, env.layout)
    kind = made["features_extractor_class"]
    extractor = kind(env.single_observation_space, **made["features_extractor_kwargs"])
    return env.layout, extractor


def test_features_are_the_observation_and_the_landings() -> None:
    env = empty_fields(2.0)
    layout, extractor = layout_and_extractor(2.0)
    length = layout["bricks"].stop
    seen = torch.from_numpy(observe_anew(env).copy())[:, :length]
    features = extractor(seen)
    assert features.shape == (WORLDS, length + EXTRA) == (WORLDS, extractor.features_dim)
    assert torch.equal(features[:, :length], seen)
    # The bricks are not needed.
    extra = extractor.extra(seen[:, : layout["bricks"].start])
    assert torch.equal(features[:, length:], extra)
    every = extra.numpy()[:, 3:].reshape(WORLDS, 3, 3)  # place, way and time of the three balls
    shown = observe_anew(env)
    x, ticks = shown[:, env.layout["landing_x"]], shown[:, env.layout["landing_ticks"]]
    np.testing.assert_allclose(every[:, 0], x, atol=1e-4)
    np.testing.assert_allclose(every[:, 1], x - shown[:, :1], atol=1e-4)
    expected = np.minimum(ticks * LANDING_TICKS / TICKS, LATEST)
    np.testing.assert_allclose(every[:, 2], expected, atol=1e-3)
    # The first three numbers are those of the ball that lands first.
    first = ticks.argmin(axis=1)
    clear = np.sort(ticks, axis=1)[:, 1] - ticks.min(axis=1) > 1e-4
    np.testing.assert_array_equal(
        extra.numpy()[clear, :3], every[np.arange(WORLDS), :, first][clear]
    )


def test_held_and_absent_balls_have_features_too() -> None:
    env = empty_fields(1.0)
    worlds = writable_states(env)
    worlds["ball_state"][:] = ABSENT, HELD, ABSENT
    worlds["ball_vx"] = worlds["ball_vy"] = 0.0
    layout, extractor = layout_and_extractor()
    seen = observe_anew(env)
    extra = extractor.extra(torch.from_numpy(seen.copy())).numpy()
    where = seen[:, layout["ball_x"]][:, 1]
    nothing = np.zeros(WORLDS)
    held = np.stack([where, where - seen[:, 0], nothing], axis=1)
    np.testing.assert_allclose(extra[:, :3], held, atol=1e-6)
    for ball, expected in enumerate((0 * held, held, 0 * held)):
        np.testing.assert_allclose(extra[:, 3 + ball :: 3], expected, atol=1e-6)


def test_a_network_with_landings_is_trained_saved_and_loaded(tmp_path: Path) -> None:
    experiment = small(tmp_path, **{"network.features": "landing", "env.speed": "2.0"})
    run = RunFolder.create(experiment)
    train(experiment, run)
    policy = load_policy(ModelFile.find(run.path), experiment)
    worlds = make_worlds(experiment, 2)
    played = play_episodes(worlds, policy, [5, 6])
    assert (played["steps"] <= 40).all()
    seen = np.zeros((2, *worlds.single_observation_space.shape), np.float32)  # type: ignore[misc]
    plain: Any = PPO.load(run.model, device="cpu")
    assert (plain.predict(seen, deterministic=True)[0] == policy(seen, np.arange(2))).all()


def test_what_an_agent_sees_is_said() -> None:
    def inputs(*settings: tuple[str, str]) -> str:
        return load_experiment("quick", [("env.landing", "false"), *settings]).inputs

    assert inputs() == "vector"
    assert inputs(("env.observation", "grid"), ("network.features", "auto")) == "grid"
    assert inputs(("env.landing", "true")).endswith("among walls, bricks and the boss")
    assert inputs(("network.features", "landing")).endswith("among the walls alone")


LAYOUT = {
    name: slice(3 * index, 3 * index + 3)
    for index, name in enumerate(
        ("paddle", "ball_in_play", "ball_held", "ball_x", "ball_y", "ball_vx", "ball_vy")
    )
}


def test_the_landing_follower_goes_where_the_next_ball_lands() -> None:
    rows = np.zeros((4, 21))
    ball = LAYOUT["ball_x"].start
    height = (PADDLE_TOP + BALL_RADIUS + 2.0) / 7 - 1  # two units above the paddle
    # Straight down; down past the right wall; up; up, and another one down.
    rows[:, LAYOUT["ball_in_play"]] = [[1, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
    rows[:, LAYOUT["ball_y"]] = height
    rows[:, ball : ball + 3] = [[0.5, 0, 0], [0.8, 0, 0], [0, -0.4, 0], [-0.9, 0.9, 0]]
    rows[:, LAYOUT["ball_vx"]] = [[0, 0, 0], [0.9, 0, 0], [0, 0.3, 0], [0, 0, 0]]
    rows[:, LAYOUT["ball_vy"]] = [[-0.5, 0, 0], [-0.3, 0, 0], [0, 0.2, 0], [0.5, -0.5, 0]]
    x = (rows[:, ball : ball + 3] + 1) * 5.5
    past = x[1, 0] + 0.9 * (2.0 / 0.3)
    mirrored = 2 * (11 - BALL_RADIUS) - past
    target, falls = next_ball(rows, LAYOUT)
    np.testing.assert_allclose(target, [x[0, 0], mirrored, x[2, 1], x[3, 1]])
    assert falls.tolist() == [True, True, False, True]
    follower = LandingFollower(THREE, LAYOUT, reach=0.76)
    rows[:, 0] = [target[0] / 5.5 - 1, 0.8, 0.0, -0.5]
    assert follower(rows, np.arange(4)).tolist() == [NO_OP, LEFT, LEFT, RIGHT]


def test_the_landing_follower_clears_far_more_than_the_ball_follower() -> None:
    """On unseen levels of middle difficulty and above, where balls are fast."""
    experiment = load_experiment("generalise", [("env.difficulty", "0.7")])
    starts = find_starts(experiment, range(1_000_000, 1_000_020))
    worlds = make_worlds(experiment, 2 * len(starts))
    landed, followed = (
        play_episodes(worlds, make_baseline(name, worlds, 0), range(2), starts, whole_games=False)
        for name in ("landing-follower", "ball-follower")
    )
    assert landed["cleared"].mean() > 0.8
    assert landed["cleared"].mean() > followed["cleared"].mean() + 0.2
