"""Data sets of recorded games, and networks that learn from them before PPO begins."""

import json
import math
from pathlib import Path
from typing import Any

import gymnasium as gym
import minari
import numpy as np
import pytest
import torch
from arkanoid.agents import cli
from arkanoid.agents.experiment.datasets import Episode, read_dataset, write_dataset
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.experiment.seeds import Purpose, spread_seeds
from arkanoid.agents.experiment.settings import Experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.learn.cloning import Demonstrations, clone, discounted
from arkanoid.agents.learn.model import make_model
from arkanoid.agents.measure.episodes import adapt
from arkanoid.envs import Replay
from helpers.runs import SMALL, sentence, small

ID = "arkanoid/follower-v0"
CONFIG = {"network.hidden": "[64]", "ppo.n_steps": "32", "training.timesteps": "256"}


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Minari's folder with games of the ball-follower."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MINARI_DATASETS_PATH", str(tmp_path_factory.mktemp("minari")))
        words = ["--games", "12", "--decisions", "600", "--level", "ripple"]
        assert cli.main(["dataset", ID, "ball-follower", "--config", "quick", *words]) == 0
        yield


def trained(output: Path, **changes: str) -> RunFolder:
    """Train a small run and return it."""
    merged = {**SMALL, **CONFIG, "output": str(output), **changes}
    assert cli.main(["train", "quick", *(f"--{key}={text}" for key, text in merged.items())]) == 0
    (path,) = output.iterdir()
    return RunFolder(path)


def test_minari_reads_the_games_that_were_played(data: None) -> None:
    """Each recorded game is played again in the environment that Minari recovers."""
    dataset = minari.load_dataset(ID)
    assert (dataset.total_episodes, dataset.spec.env_spec.id) == (12, "ArkanoidLite-v0")
    env = dataset.recover_environment()
    every = spread_seeds(0, Purpose.DATASET, 12)
    seeds = [every[0], every[7]]
    for number, episode in enumerate(dataset.iterate_episodes([0, 7])):
        seen = [env.reset(seed=seeds[number], options={"level": "ripple"})[0]]
        rewards = []
        for action in episode.actions:
            observation, reward, terminated, _, _ = env.step(action)
            seen.append(observation)
            rewards.append(reward)
        np.testing.assert_array_equal(seen, episode.observations)
        np.testing.assert_array_equal(rewards, episode.rewards)
        assert terminated == episode.terminations[-1]
        assert episode.truncations[-1] == (len(rewards) == 600 and not terminated)
        assert not episode.terminations[:-1].any()
    env.close()


def test_a_model_s_games_can_be_seen_as_pictures(data: None, tmp_path: Path) -> None:
    """The network sees numbers; the data set shows the same games as pictures."""
    run = trained(tmp_path / "runs")
    words = ["--games", "2", "--decisions", "30"]
    assert cli.main(["dataset", "arkanoid/numbers-v0", str(run.path), *words]) == 0
    looks = ["--env.observation", "rgb", "--env.size", "32", "--env.grey", "true"]
    assert cli.main(["dataset", "arkanoid/pictures-v0", str(run.path), *words, *looks]) == 0
    numbers = minari.load_dataset("arkanoid/numbers-v0")
    pictures = minari.load_dataset("arkanoid/pictures-v0")
    env = pictures.recover_environment()
    for one, other in zip(numbers, pictures, strict=True):
        np.testing.assert_array_equal(one.actions, other.actions)
        np.testing.assert_array_equal(one.rewards, other.rewards)
        assert other.observations.shape == (31, 1, 32, 32)
    np.testing.assert_array_equal(
        env.reset(seed=spread_seeds(0, Purpose.DATASET, 2)[0])[0], pictures[0].observations[0]
    )
    env.close()


def test_a_packaged_agent_s_games_become_a_data_set(data: None) -> None:
    """Its name, which is no path, was refused as neither a baseline nor a file."""
    words = ["dataset", "arkanoid/full-v0", "full", "--games", "2", "--decisions", "5"]
    assert cli.main(words) == 0
    assert minari.load_dataset("arkanoid/full-v0").total_episodes == 2


def test_replays_become_a_data_set(data: None, tmp_path: Path) -> None:
    env: Any = gym.make("arkanoid:Arkanoid-v0", lives=1).unwrapped
    paths = []
    for seed in (1, 2):
        recorder = env.record()
        env.reset(seed=seed)
        env.action_space.seed(seed)
        while not env.step(env.action_space.sample())[2]:
            pass
        paths.append(tmp_path / f"{seed}.replay")
        recorder.replay().save(paths[-1])
    assert cli.main(["dataset", "arkanoid/human-v0", *map(str, paths)]) == 0
    for path, episode in zip(paths, minari.load_dataset("arkanoid/human-v0"), strict=True):
        result = Replay.load(path).result
        assert (len(episode.actions), episode.terminations[-1]) == (result.decisions, True)
        assert episode.rewards.sum() == pytest.approx(result.reward)


def test_a_clone_of_the_ball_follower_plays_far_above_random(data: None, tmp_path: Path) -> None:
    """A learning rate of nothing lets PPO change nothing."""
    changes = {"imitation.dataset": ID, "imitation.epochs": "40", "ppo.learning_rate": "1e-30"}
    changes |= {"evaluation.episodes": "20", "evaluation.baselines": '["random"]'}
    run = trained(tmp_path, **changes, **{"env.max_decisions": "27_000"})
    played = json.loads(run.evaluation.read_text())["suites"]["games"]["policies"]
    hits = {name: one["summary"]["hits"]["mean"] for name, one in played.items()}
    assert hits["agent"]["low"] > 3 * hits["random"]["high"]
    lineage = run.read_notes()["lineage"]
    assert (lineage["kind"], lineage["name"], lineage["episodes"]) == ("data set", ID, 12)
    assert lineage["accuracy"] > 0.6
    assert lineage["decisions"] == minari.load_dataset(ID).total_steps


def test_a_cloned_run_is_reproduced_without_the_data_set(
    data: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Cloning draws no random number that PPO would draw, so its result is enough."""
    run = trained(tmp_path, **{"imitation.dataset": ID, "imitation.epochs": "1"})
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path / "empty"))
    capsys.readouterr()
    assert cli.main(["reproduce", str(run.path)]) == 0
    assert "the same, bit for bit" in capsys.readouterr().out


def test_a_continuous_policy_keeps_its_noise(tmp_path: Path) -> None:
    """A likelihood would take all noise from it, and PPO could not explore."""
    experiment = small(
        tmp_path, **{"env.actions": "box", "imitation.epochs": "30", "imitation.batch_size": "16"}
    )
    venv = adapt(make_worlds(experiment, experiment.training.worlds))
    model = make_model(experiment, venv)
    random = np.random.default_rng(0)
    size = venv.observation_space.shape
    assert size is not None
    episodes = [
        Episode(
            random.uniform(-1, 1, (51, *size)).astype(np.float32),
            np.tile(np.float32([0.7, -0.7]), (50, 1)),
            np.ones(50),
            True,
        )
        for _ in range(4)
    ]
    noise = model.policy.log_std.detach().clone()
    before = model.policy.predict(episodes[0].observations, deterministic=True)[0]
    result = clone(model, Demonstrations.of(episodes, 0.9), experiment)
    after = model.policy.predict(episodes[0].observations, deterministic=True)[0]
    assert result.accuracy is None
    torch.testing.assert_close(model.policy.log_std.detach(), noise)
    target = [0.7, -0.7]
    assert np.abs(after - target).mean() < np.abs(before - target).mean() / 2
    venv.close()


def test_returns_are_discounted_and_cut_games_are_doubted() -> None:
    rewards = np.array([1.0, 0.0, 2.0])
    np.testing.assert_allclose(discounted(rewards, 0.5), [1.5, 1.0, 2.0])
    observations = np.zeros((4, 2), np.float32)
    actions = np.zeros(3, np.int64)
    lost = Episode(observations, actions, rewards, terminated=True)
    cut = Episode(observations, actions, rewards, terminated=False)
    both = Demonstrations.of([lost, cut], 0.5)
    np.testing.assert_allclose(both.certain, [1, 1, 1, 0.875, 0.75, 0.5])
    assert both.lengths == (3, 3)


def env_of(experiment: Experiment) -> Any:
    return gym.make(experiment.env_id, **experiment.game.plain())


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("actions", np.int64([0, 1, 3]), "actions"),
        ("observations", math.nan, "observations"),
        ("rewards", np.array([0.0, math.inf, 0.0]), "rewards"),
        ("actions", np.int64([0, 1]), "other lengths"),
    ],
)
def test_damaged_data_is_refused(
    name: str,
    value: Any,
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path / "minari"))
    experiment = small(tmp_path)
    env = env_of(experiment)
    arrays: dict[str, Any] = {
        "observations": np.zeros((4, *env.observation_space.shape), np.float32),
        "actions": np.zeros(3, np.int64),
        "rewards": np.zeros(3),
    }
    arrays[name] = np.full_like(arrays[name], value) if isinstance(value, float) else value
    episodes = iter([Episode(**arrays, terminated=True)])
    write_dataset("arkanoid/bad-v0", episodes, env, "nobody", "damaged")
    with pytest.raises(ValueError, match=words):
        read_dataset("arkanoid/bad-v0", env.observation_space, env.action_space)


def test_no_environment_of_a_received_data_set_is_made(
    data: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without spaces Minari makes the environment that the file names, which can run any code."""
    folder = tmp_path / "received"
    folder.mkdir()
    metadata = {"total_episodes": 1, "data_format": "hdf5", "env_spec": "{}"}
    (folder / "metadata.json").write_text(json.dumps(metadata), encoding="utf-8")
    words = ["train", "quick", "--imitation.dataset", str(folder), "--output", str(tmp_path / "x")]
    assert "spaces" in sentence(words, capsys)


def test_mistakes_get_a_sentence_before_anything_is_played(
    data: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "no id of a data set" in sentence(["dataset", "mine", "planner"], capsys)
    assert "there is such a data set" in sentence(["dataset", ID, "planner"], capsys)
    new = ["dataset", "arkanoid/new-v0"]
    assert "several players" in sentence([*new, "planner", "random"], capsys)
    assert "config.toml" in sentence([*new, str(tmp_path)], capsys)
    train = ["train", "quick", "--output", str(tmp_path / "runs")]
    wrong = ["--imitation.dataset", "arkanoid/nothing-v0"]
    assert "no such data set" in sentence([*train, *wrong], capsys)
    seen = ["--imitation.dataset", ID, "--env.observation", "grid", "--network.features", "auto"]
    seen += ["--env.landing", "false"]
    assert "its observations are float32" in sentence([*train, *seen], capsys)
    acted = ["--imitation.dataset", ID, "--env.actions", "discrete6"]
    assert "its actions are one of 3" in sentence([*train, *acted], capsys)
    assert not (tmp_path / "runs").exists()
