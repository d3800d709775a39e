"""During a training: validation, the curriculum, and the networks' features."""

from collections import deque
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from arkanoid.agents.experiment.packaged import packaged_configs
from arkanoid.agents.experiment.provenance import weights_hash
from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.experiment.settings import Curriculum, Experiment, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds, native
from arkanoid.agents.learn import training
from arkanoid.agents.learn.collapse import PATIENCE, CollapseWatch
from arkanoid.agents.learn.curves import STEP, read_curve
from arkanoid.agents.learn.model import load_policy, make_model
from arkanoid.agents.learn.networks import LatticeExtractor, PlanesExtractor
from arkanoid.agents.learn.stages import stage_at, stage_options
from arkanoid.agents.learn.training import train
from arkanoid.agents.measure.episodes import adapt
from gymnasium import spaces
from stable_baselines3 import PPO
from stable_baselines3.common.logger import Logger

SMALL = [("training.timesteps", "6144"), ("training.worlds", "16"), ("ppo.n_steps", "64")]
SMALL += [("ppo.batch_size", "256"), ("ppo.n_epochs", "1"), ("env.max_decisions", "150")]


def small(output: Path, *overrides: tuple[str, str]) -> Experiment:
    return load_experiment("quick", [*SMALL, *overrides, ("output", str(output))])


def trained(experiment: Experiment, **arguments: Any) -> tuple[str, RunFolder]:
    run = RunFolder.create(experiment)
    return train(experiment, run, **arguments), run


@pytest.mark.parametrize("deterministic", ["true", "false"])
def test_validation_changes_no_weight(tmp_path: Path, deterministic: str) -> None:
    """Even if it draws its actions, it must not draw a number that the training would draw."""
    draws = ("evaluation.deterministic", deterministic)
    every = (("validation.every", "2048"), ("validation.episodes", "3"))
    outcomes = [trained(small(tmp_path, draws, *more)) for more in ((), every)]
    hashes = [run.read_notes()["weights"] for _, run in outcomes]
    assert hashes[0] == hashes[1]
    assert not outcomes[0][1].best.exists()
    assert outcomes[1][1].best.exists()


def test_patience_ends_the_training(tmp_path: Path) -> None:
    seen: list[tuple[int, float]] = []

    def judge(step: int, means: dict[str, float]) -> None:
        seen.append((step, means["return"]))

    # No level is ever cleared, so no measurement is better than the first one.
    options = (("validation.every", "1024"), ("validation.episodes", "2"))
    options += (("validation.best", "cleared"), ("validation.patience", "2"))
    outcome, run = trained(small(tmp_path, *options), on_measure=judge)
    assert outcome == "2 measurements without a better one at 3072 decisions"
    assert [step for step, _ in seen] == [1024, 2048, 3072]
    assert run.read_notes()["outcome"] == outcome
    assert run.read_notes()["timesteps"] == 3072
    # Of equals the latest is the best.
    best = PPO.load(run.best, device="cpu").policy.state_dict()
    assert weights_hash(best) == run.read_notes()["weights"]


def test_the_best_model_is_that_of_the_best_measurement(tmp_path: Path) -> None:
    """A run that ends at that step has the same weights."""
    constant = ("ppo.schedule", "constant")
    options = (("validation.every", "1024"), ("validation.episodes", "2"), constant)
    _, run = trained(small(tmp_path, *options))
    measured = {
        row["validation/return"]: row[STEP]
        for row in read_curve(run.curve)
        if "validation/return" in row
    }
    step = str(measured[max(measured)])
    _, shorter = trained(small(tmp_path, ("training.timesteps", step), constant))
    best = PPO.load(run.best, device="cpu").policy.state_dict()
    assert weights_hash(best) == shorter.read_notes()["weights"]


def test_a_cleared_rate_ends_the_training(tmp_path: Path) -> None:
    """The level has a few bricks low down, which even an untrained policy sometimes clears."""
    level = tmp_path / "easy.txt"
    rows = ["...........", "...www....."]
    level.write_text("name: Easy\ncomment: For a test.\n\n" + "\n".join(rows) + "\n")
    options = (("env.levels", str(level)), ("env.lives", "50"), ("env.max_decisions", "27000"))
    options += (("validation.every", "1024"), ("validation.stop_at", "0.01"))
    options += (("validation.levels", f'["{level}"]'), ("evaluation.deterministic", "false"))
    outcome, run = trained(small(tmp_path, *options))
    assert outcome.startswith("cleared rate ")
    assert run.read_notes()["weights"] is not None


def warnings_of(run: RunFolder) -> list[str]:
    found: list[str] = run.read_notes().get("warnings", [])
    return found


LONG = [("training.timesteps", "40960"), ("validation.every", "10240")]
LONG += [("validation.episodes", "2")]
LONG += [("validation.levels", '["ripple", "vault"]')]


def test_a_healthy_training_gets_no_warning(tmp_path: Path) -> None:
    """From the first decision on, when it is as poor as random play."""
    _, run = trained(small(tmp_path, *LONG))
    assert warnings_of(run) == []


def test_a_collapsed_policy_is_noticed_once_and_stays_noted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It always went left. Nothing said so until the evaluation."""
    monkeypatch.setattr(training, "make_model", collapsed_model((0.0, 30.0, 0.0)))
    _, run = trained(small(tmp_path, *LONG, ("ppo.learning_rate", "1e-9")))
    everywhere, on_levels = sorted(warnings_of(run), key=len)
    assert "100.0 % of its actions are the same" in everywhere
    assert "'ppo.ent_coef'" in everywhere
    assert "collapsed on ripple, vault" in on_levels
    told = capsys.readouterr().err
    for warning in (everywhere, on_levels):
        assert told.count(f"arkanoid: warning: {warning}") == 1


def test_a_policy_is_certain_or_poor_or_both(tmp_path: Path) -> None:
    """Only both are a collapse: a good policy may be certain, a new one poor."""
    experiment = small(tmp_path)
    venv = adapt(make_worlds(experiment, 16))
    model = make_model(experiment, venv)
    model.set_logger(Logger(None, []))
    for entropy, gain, is_collapse in [(0.01, -9.0, True), (0.01, 9.0, False), (1.0, -9.0, False)]:
        told: list[str] = []
        watch = CollapseWatch(experiment, {}, told.append)
        watch.init_callback(model)
        model.ep_info_buffer = deque([{"r": gain}])
        for rollout in range(4):
            model.logger.record("train/entropy_loss", -entropy)
            watch.on_rollout_start()
            for _ in range(PATIENCE // 48 + 1):
                watch.update_locals({"actions": np.arange(16) % 3})
                watch.on_step()
            watch.on_rollout_end()
            assert len(told) == (is_collapse and rollout >= 2)
        assert all("certain of its actions" in message for message in told)


def collapsed_model(logits: tuple[float, ...]) -> Any:
    """Return a `make_model` whose policy always has these logits."""

    def make(*arguments: Any) -> PPO:
        model = make_model(*arguments)
        head: Any = model.policy.action_net
        with torch.no_grad():
            head.weight.zero_()
            head.bias.copy_(torch.tensor(logits))
        return model

    return make


def test_stages_begin_at_their_parts_of_the_training() -> None:
    curriculum = Curriculum(stages=(0.25, 0.5), rounds=(1, 2, 3), difficulty=(0.2, 0.4, 1.0))
    parts = (0.0, 0.24, 0.25, 0.49, 0.5, 1.0)
    assert [stage_at(curriculum, part) for part in parts] == [0, 0, 1, 1, 2, 2]
    options = stage_options(curriculum, 2, 4)
    assert [option["level"] for option in options] == [1, 2, 3, 1]
    assert [option["difficulty"] for option in options] == [0.25, 0.5, 0.75, 1.0]
    assert stage_options(Curriculum(), 0, 2) == [{}, {}]


def test_the_curriculum_reaches_the_worlds(tmp_path: Path) -> None:
    experiment = small(tmp_path)
    experiment = replace(experiment, curriculum=Curriculum(rounds=(3,)))
    venv = adapt(make_worlds(experiment, 16))
    venv.set_options(stage_options(experiment.curriculum, 0, 16))
    venv.reset()
    assert [info["round"] for info in venv.reset_infos] == [1 + world % 3 for world in range(16)]


def test_convolutions_see_the_bricks_of_a_vector_as_a_picture() -> None:
    """Each cell reaches the convolutions at its place."""
    experiment = load_experiment("quick")
    layout = native(make_worlds(experiment, 1)).layout
    length = max(part.stop for part in layout.values())
    bricks = layout["bricks"]
    extractor = LatticeExtractor(
        spaces.Box(-1, 1, (length,), np.float32), (bricks.start, bricks.stop), (1,), 4, "relu"
    )
    seen: list[torch.Tensor] = []
    convolution = next(m for m in extractor.modules() if isinstance(m, torch.nn.Conv2d))
    convolution.register_forward_pre_hook(lambda module, given: seen.append(given[0]))
    observations = torch.arange(2 * length, dtype=torch.float32).reshape(2, length)
    features = extractor(observations)
    assert features.shape == (2, extractor.features_dim) == (2, length - 198 + 4)
    np.testing.assert_array_equal(
        seen[0].numpy(), observations[:, bricks].numpy().reshape(2, 1, 18, 11)
    )
    outside = np.delete(observations.numpy(), np.r_[bricks], axis=1)
    np.testing.assert_array_equal(features.detach().numpy()[:, : length - 198], outside)


def test_planes_of_any_size_become_features() -> None:
    for shape in ((3, 28, 11), (1, 7, 5), (12, 1, 1)):
        space = spaces.Box(0, 1, shape, np.float32)
        extractor = PlanesExtractor(space, (4, 8), 16, "tanh")
        assert extractor(torch.zeros(5, *shape)).shape == (5, 16)


def test_a_lattice_of_another_size_is_refused() -> None:
    with pytest.raises(ValueError, match="198 cells; the slice has 3"):
        LatticeExtractor(spaces.Box(-1, 1, (9,), np.float32), (2, 5), (4,), 4, "relu")


@pytest.mark.parametrize(
    "overrides",
    [
        [],
        [("env.observation", "grid")],
        [("env.observation", "rgb"), ("env.grey", "true"), ("env.stack", "2")],
        [("env.observation", "rgb")],
        [("env.observation", "rgb"), ("env.size", "48"), ("network.features", "planes")],
        [("env.actions", "box")],
    ],
    ids=str,
)
def test_the_network_suits_the_observation(
    tmp_path: Path, overrides: list[tuple[str, str]]
) -> None:
    """Trained, saved and loaded again, it plays as it did."""
    options = [("network.features", "auto"), ("training.timesteps", "1024")]
    options += [("env.landing", "false")]
    experiment = small(tmp_path, *options, *overrides)
    _, run = trained(experiment)
    worlds = make_worlds(experiment, 4)
    observations, _ = worlds.reset(seed=0)
    actions = load_policy(ModelFile.find(str(run.model)), experiment)(observations, np.arange(4))
    assert worlds.action_space.contains(actions)
    assert run.model.stat().st_size < 20_000_000


def test_a_saved_model_holds_no_optimiser_state(tmp_path: Path) -> None:
    experiment = small(tmp_path, ("training.timesteps", "1024"))
    _, run = trained(experiment)
    loaded = PPO.load(run.model, device="cpu")
    assert loaded.policy.optimizer.state_dict()["state"] == {}
    again = make_model(experiment, adapt(make_worlds(experiment, 16)))
    assert [p.shape for p in again.policy.parameters()] == [
        p.shape for p in loaded.policy.parameters()
    ]


@pytest.mark.parametrize("name", packaged_configs())
def test_every_packaged_config_can_be_trained(name: str, tmp_path: Path) -> None:
    """With curriculum and validation as it says, but only for a moment."""
    overrides = [("training.worlds", "4"), ("training.timesteps", "192"), ("ppo.n_steps", "16")]
    overrides += [
        ("ppo.batch_size", "64"),
        ("validation.every", "64"),
        ("validation.episodes", "1"),
    ]
    overrides += [("env.max_decisions", "30"), ("output", str(tmp_path))]
    outcome, run = trained(load_experiment(name, overrides))
    assert outcome == "finished"
    assert run.best.is_file()
    assert run.read_notes()["timesteps"] == 192
