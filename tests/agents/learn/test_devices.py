"""Trainer and device are settings. There need be no graphics card here."""

from dataclasses import replace
from pathlib import Path

import pytest
import torch
from arkanoid.agents import cli
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.experiment.settings import Experiment, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.learn.model import load_policy, make_model
from arkanoid.agents.learn.playing import find_device
from arkanoid.agents.learn.ppo import FastPPO
from arkanoid.agents.learn.training import train
from arkanoid.agents.measure.episodes import adapt
from stable_baselines3 import PPO

SMALL = {
    "training.timesteps": "512",
    "training.worlds": "4",
    "ppo.n_steps": "64",
    "ppo.batch_size": "64",
    "ppo.n_epochs": "1",
    "evaluation.episodes": "1",
    "evaluation.baselines": "[]",
    "evaluation.film_seconds": "0.1",
}


@pytest.fixture
def no_card(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)


def small(**changes: str) -> Experiment:
    return load_experiment("quick", list({**SMALL, **changes}.items()))


@pytest.mark.parametrize(("trainer", "kind"), [("fast", FastPPO), ("sb3", PPO)])
def test_the_setting_chooses_the_trainer(trainer: str, kind: type) -> None:
    experiment = small(**{"training.trainer": trainer})
    venv = adapt(make_worlds(experiment, experiment.training.worlds))
    assert type(make_model(experiment, venv)) is kind
    venv.close()


@pytest.mark.usefixtures("no_card")
def test_without_a_graphics_card_auto_is_the_processor_and_cuda_gets_a_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It also left the folder of a run that had not begun."""
    assert find_device("auto") == find_device("cpu") == torch.device("cpu")
    with pytest.raises(SettingsError, match=r"'training.device' = 'cuda'.*'auto' or 'cpu'"):
        find_device("cuda")
    settings = {**SMALL, "training.device": "cuda", "output": str(tmp_path)}
    assert cli.main(["train", "quick", *(f"--{key}={text}" for key, text in settings.items())]) == 2
    assert "graphics card" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.usefixtures("no_card")
def test_a_run_that_was_trained_on_a_card_plays_without_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    experiment = replace(small(), output=str(tmp_path))
    folder = RunFolder.create(experiment)
    assert train(experiment, folder) == "finished"
    as_on_card = folder.config.read_text().replace('device = "cpu"', 'device = "cuda"')
    folder.config.write_text(as_on_card)
    model = ModelFile.find(str(folder.path), False)
    on_card = model.run.experiment()
    assert on_card.training.device == "cuda"
    load_policy(model, on_card)
    # A resumed run takes no options: its file says where it is trained.
    assert cli.main(["train", "--resume", str(folder.path)]) == 2
    assert "finished" in capsys.readouterr().err
    folder.add_notes(outcome="interrupted")
    assert cli.main(["train", "--resume", str(folder.path)]) == 2
    assert f"{folder.config}: 'training.device' = 'cuda'" in capsys.readouterr().err
    # Who asks for a card gets no other device.
    folder.config.write_text(as_on_card.replace('device = "cuda"', 'device = "cpu"'))
    with pytest.raises(SettingsError, match="graphics card"):
        load_policy(model, on_card)
