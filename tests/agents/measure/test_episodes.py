"""Playing and comparing: episodes, levels, tables and JSON."""

import json
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.seeds import Purpose, spread_seed, spread_seeds
from arkanoid.agents.experiment.settings import Experiment, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.measure.baselines import NoOp, make_baseline
from arkanoid.agents.measure.comparison import (
    COLUMNS,
    as_json,
    as_tables,
    compare,
    count_games,
    level_interval,
    summarise,
)
from arkanoid.agents.measure.episodes import play_episodes
from arkanoid.agents.measure.policy import Policy
from arkanoid.agents.measure.suites import EpisodeStart, find_starts, make_suites
from scipy import stats

SPACE = gym.spaces.Discrete(3)


def follower(experiment: Experiment) -> Policy:
    return make_baseline("ball-follower", make_worlds(experiment, 1), seed=0)


def test_an_episode_depends_only_on_its_seed() -> None:
    """Against single environments, played one after the other by Gymnasium's own rules."""
    experiment = load_experiment("quick", [("env.lives", "1")])
    policy = follower(experiment)
    played = play_episodes(make_worlds(experiment, 6), policy, range(70, 76))
    single = gym.make("ArkanoidLite-v0", **experiment.env)
    for index in range(6):
        observation, _ = single.reset(seed=70 + index)
        total, steps, hits, cleared, over = 0.0, 0, 0, 0, False
        while not over:
            action = policy(observation[None], np.zeros(1, int))[0]
            observation, reward, terminated, truncated, info = single.step(action)
            total, steps, hits = total + float(reward), steps + 1, hits + info["hits"]
            cleared += info["rounds_cleared"]
            over = terminated or truncated
        assert played["return"][index, 0] == total
        assert played["steps"][index, 0] == steps
        assert played["hits"][index, 0] == hits
        assert played["rounds_cleared"][index, 0] == cleared
        assert played["cleared"][index, 0] == (cleared > 0)
        for key in ("score", "lives", "round", "bricks_left"):
            assert played[key][index, 0] == info[key]


def test_a_level_is_played_until_it_is_cleared_whatever_other_worlds_play() -> None:
    experiment = load_experiment("quick")
    starts = find_starts(experiment, ["comb", "seeds:3-3", "islands"])
    policy = follower(experiment)
    together = play_episodes(make_worlds(experiment, 9), policy, range(40, 43), starts, False)
    assert together["cleared"].shape == (3, 3)
    single = gym.make("ArkanoidLite-v0", **experiment.env)
    for level, start in enumerate(starts):
        for episode in range(3):
            observation, _ = single.reset(seed=40 + episode, options=start.options)
            steps, over = 0, False
            while not over:
                action = policy(observation[None], np.zeros(1, int))[0]
                observation, _, terminated, truncated, info = single.step(action)
                steps += 1
                over = terminated or truncated or info["rounds_cleared"] > 0
            assert together["steps"][episode, level] == steps
            assert together["score"][episode, level] == info["score"]
            assert together["lives"][episode, level] == info["lives"]
            assert together["cleared"][episode, level] == (info["rounds_cleared"] > 0)


def test_equal_seeds_of_two_purposes_have_no_episode_in_common() -> None:
    """More episodes begin with the same ones. Validation and evaluation took seeds from N on."""
    found = {purpose: spread_seeds(7, purpose, 500) for purpose in Purpose}
    assert len(set().union(*found.values())) == 500 * len(Purpose)
    for purpose, seeds in found.items():
        assert spread_seeds(7, purpose, 3) == seeds[:3]
        assert spread_seed(7, purpose, 2) == seeds[2]
        assert spread_seed(7, purpose, 2, bits=32) == seeds[2] // 2**32


def test_an_earlier_evaluation_in_the_same_worlds_leaves_nothing_behind() -> None:
    experiment = load_experiment("quick")
    worlds = make_worlds(experiment, 4)
    policy = NoOp(SPACE)
    first = play_episodes(worlds, policy, range(4))
    play_episodes(
        worlds, policy, range(2), find_starts(experiment, ["seeds:3-4"]), whole_games=False
    )
    again = play_episodes(worlds, policy, range(4))
    for name, values in first.items():
        np.testing.assert_array_equal(values, again[name])


def test_each_level_needs_the_same_number_of_worlds() -> None:
    experiment = load_experiment("quick")
    with pytest.raises(ValueError, match="3 worlds for 2 levels times 1 episode"):
        play_episodes(
            make_worlds(experiment, 3), NoOp(SPACE), [0], [EpisodeStart("a"), EpisodeStart("b")]
        )


def test_suites_keep_training_test_and_named_levels_apart() -> None:
    every = '["games", "training", "test", "named"]'
    overrides = [("evaluation.suites", every), ("evaluation.generated", "5")]
    suites = make_suites(load_experiment("generalise", overrides))
    assert set(suites) == {"games", "training", "test", "named"}
    training, test = ([s.options for s in suites[name].starts] for name in ("training", "test"))
    assert all(options is not None and options["seed"] < 9000 for options in training)
    assert all(options is not None and options["seed"] >= 1_000_000 for options in test)
    assert [options and options["difficulty"] for options in test] == [0, 0.25, 0.5, 0.75, 1]
    names = [start.name for start in suites["named"].starts]
    assert names[0] == "ripple"
    assert "warden" not in names  # the boss is an enemy, and the lite game has none
    full = make_suites(load_experiment("full", [("evaluation.suites", every)]))
    assert "training" not in full
    assert full["named"].starts[-1].name == "warden"


def test_named_stands_for_all_named_levels_of_the_game() -> None:
    """Configs once listed the twelve names for their validation."""
    lite, full = load_experiment("lite"), load_experiment("full")
    assert lite.validation.levels == ("named",)
    assert len(find_starts(lite, lite.validation.levels)) == 12
    assert [start.name for start in find_starts(full, ["named", "seeds:3-3"])][-2:] == [
        "warden",
        "3 at 0.50",
    ]


def test_a_fixed_difficulty_is_that_of_all_generated_levels() -> None:
    experiment = load_experiment("generalise", [("env.difficulty", "0.3")])
    starts = find_starts(experiment, "seeds:10-12")
    assert [start.options for start in starts] == [
        {"seed": seed, "difficulty": 0.3} for seed in (10, 11, 12)
    ]


@pytest.mark.parametrize("level", ["no_such_round", "seeds:9-3", "warden"])
def test_a_level_that_the_game_does_not_have_is_a_settings_error(level: str) -> None:
    with pytest.raises(SettingsError, match=level):
        find_starts(load_experiment("quick"), level)


@pytest.fixture(scope="module")
def small() -> Experiment:
    full = [("env_id", "Arkanoid-v0"), ("env.max_decisions", "150")]
    experiment = load_experiment("quick", full)
    return replace(
        experiment,
        evaluation=replace(
            experiment.evaluation,
            suites=("games", "named"),
            episodes=4,
            level_episodes=2,
            planner_episodes=1,
        ),
    )


class Told:
    """What a comparison tells about its progress."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.games = 0

    def name(self, what: str) -> None:
        self.names.append(what)

    def ended(self, games: int) -> None:
        self.games += games


def test_a_comparison_has_all_policies_on_all_levels(small: Experiment) -> None:
    told = Told()
    agent = follower(small)
    comparison = compare(small, {"agent": [agent, NoOp(SPACE)]}, told)
    assert set(comparison["games"]) == {
        "agent",
        "no-op",
        "random",
        "ball-follower",
        "landing-follower",
    }
    assert set(comparison["named"]) == {*comparison["games"], "planner"}
    assert comparison["named"]["agent"]["score"].shape == (2, 2, 13)
    assert comparison["named"]["planner"]["score"].shape == (1, 1, 13)
    assert "named: planner" in told.names
    assert told.games == count_games(small, models=2)
    # The agent's first model is the ball-follower, its second one does nothing.
    for suite in comparison.values():
        for name in COLUMNS:
            for model, baseline in enumerate(("ball-follower", "no-op")):
                np.testing.assert_array_equal(suite["agent"][name][model], suite[baseline][name][0])
    result = json.loads(json.dumps(as_json(small, comparison, {"agent": ["first", "second"]})))
    named = result["suites"]["named"]
    assert named["levels"][0] == "ripple"
    score = named["policies"]["agent"]["summary"]["score"]
    samples = comparison["named"]["agent"]["score"]
    assert score["mean"]["estimate"] == pytest.approx(samples.mean())
    assert score["mean"]["low"] <= score["mean"]["estimate"] <= score["mean"]["high"]
    trimmed = stats.trim_mean(samples.mean(axis=1), 0.25, axis=None)
    assert score["iqm"]["estimate"] == pytest.approx(float(trimmed))
    of_level = named["policies"]["agent"]["levels"]["ripple"]["score"]["estimate"]
    assert of_level == pytest.approx(samples[:, :, 0].mean())
    text = as_tables(small, comparison, 80)
    assert max(map(len, text.splitlines())) <= 80
    assert "named: 13 levels, 2 episodes of each; interquartile mean" in text
    for name in (*comparison["named"], *COLUMNS.values(), "switchback"):
        assert name in text


def test_several_models_are_resampled_instead_of_their_episodes() -> None:
    """One model always gets 0, the other 1: the mean of a resample is anything between."""
    samples = np.stack([np.zeros((50, 1)), np.ones((50, 1))])
    summary = summarise(samples)["mean"]
    assert (summary.low, summary.estimate, summary.high) == (0, 0.5, 1)
    assert level_interval(samples, 0) == summary
    # One model with the same hundred episodes has its episodes resampled.
    one = summarise(samples.reshape(1, 100, 1))["mean"]
    assert 0.35 < one.low < 0.5 < one.high < 0.65
