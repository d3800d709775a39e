"""Runs that begin with the weights of another model, and what they keep of it."""

import hashlib
import json
import shutil
import zipfile
from pathlib import Path

import pytest
from arkanoid.agents import cli
from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.learn.model import read_weights
from arkanoid.agents.learn.training import train
from helpers.runs import SMALL, sentence, small
from stable_baselines3 import PPO


def settings(output: Path, **changes: str) -> list[str]:
    return [f"--{key}={text}" for key, text in {**SMALL, "output": str(output), **changes}.items()]


def newest(output: Path) -> RunFolder:
    return RunFolder(max(output.iterdir(), key=lambda path: path.stat().st_mtime_ns))


@pytest.fixture(scope="module")
def parent(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    experiment = small(tmp_path_factory.mktemp("parent"))
    run = RunFolder.create(experiment)
    train(experiment, run)
    return run


@pytest.fixture(scope="module")
def child(parent: RunFolder, tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    """A run of half as many decisions, with another learning rate."""
    output = tmp_path_factory.mktemp("child")
    changes = {"training.timesteps": "1024", "ppo.learning_rate": "1e-4", "output": str(output)}
    words = [f"--{key}={text}" for key, text in changes.items()]
    assert cli.main(["train", "--from", str(parent.path), *words]) == 0
    return newest(output)


def test_a_run_begins_with_the_weights_of_another(parent: RunFolder, child: RunFolder) -> None:
    """Stable-baselines3 reads the weights here, and not the code under test."""
    digest = hashlib.sha256()
    for name, tensor in sorted(PPO.load(child.start, device="cpu").policy.state_dict().items()):
        array = tensor.numpy()
        digest.update(f"{name} {array.dtype.str} {array.shape}\n".encode() + array.tobytes())
    assert parent.read_notes()["weights"] == digest.hexdigest()
    assert child.read_notes()["lineage"] == {
        "kind": "model",
        "name": str(parent.model),
        "decisions": 2048,
        "weights": digest.hexdigest(),
    }
    # Without CONFIG the other run's settings hold.
    experiment = child.experiment()
    assert experiment.network.hidden == (8,)
    assert experiment.ppo.learning_rate == 1e-4
    # A learning rate of nothing leaves the weights as they were.
    still = RunFolder.create(small(child.path.parent, **{"ppo.learning_rate": "1e-30"}))
    shutil.copy(child.start, still.start)
    train(still.experiment(), still)
    expected = read_weights(parent.model, parent.experiment())
    for name, tensor in read_weights(still.model, still.experiment()).items():
        assert (tensor - expected[name]).abs().max() < 1e-6


def test_decisions_add_up_over_generations(child: RunFolder, tmp_path: Path) -> None:
    words = settings(tmp_path, **{"training.timesteps": "256"})
    assert cli.main(["train", "quick", "--from", str(child.model), *words]) == 0
    lineage = newest(tmp_path).read_notes()["lineage"]
    assert lineage["decisions"] == 2048 + 1024


def test_a_lone_model_of_others_needs_a_config(
    parent: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lone = tmp_path / "lone" / "mine.zip"
    lone.parent.mkdir()
    with zipfile.ZipFile(parent.model) as ours, zipfile.ZipFile(lone, "w") as theirs:
        for name in ours.namelist():
            if name != "config.toml":
                theirs.writestr(name, ours.read(name))
    assert "config.toml" in sentence(["train", "--from", str(lone)], capsys)
    words = settings(tmp_path / "runs", **{"training.timesteps": "256"})
    assert cli.main(["train", "quick", "--from", str(lone), *words]) == 0
    lineage = newest(tmp_path / "runs").read_notes()["lineage"]
    assert (lineage["name"], lineage["decisions"]) == (str(lone), 2048)
    assert lineage["weights"] == parent.read_notes()["weights"]


def test_a_model_plays_without_its_folder(
    parent: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lone = tmp_path / "mine.zip"
    shutil.copy(parent.model, lone)
    results = []
    for name in (lone, parent.model):
        assert cli.main(["evaluate", str(name), "--json"]) == 0
        results.append(json.loads(capsys.readouterr().out))
    assert results[0]["suites"] == results[1]["suites"]
    weights = ModelFile.find(str(lone)).experiment().network
    assert weights == parent.experiment().network


def test_a_lone_model_imports_no_module(
    parent: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lone = tmp_path / "theirs.zip"
    with zipfile.ZipFile(parent.model) as ours, zipfile.ZipFile(lone, "w") as theirs:
        theirs.writestr("policy.pth", ours.read("policy.pth"))
        theirs.writestr("config.toml", 'env_id = "evil:Game-v0"')
    assert "add --trust" in sentence(["evaluate", str(lone)], capsys)


@pytest.mark.parametrize(
    "changes",
    [{"network.hidden": "[16]"}, {"network.hidden": "[4]"}, {"env.actions": "discrete6"}],
)
def test_another_network_is_refused_before_a_run_is_made(
    changes: dict[str, str],
    parent: RunFolder,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    output = tmp_path / "runs"
    words = ["train", "quick", "--from", str(parent.path), *settings(output, **changes)]
    assert "same network" in sentence(words, capsys)
    assert not output.exists()


def test_the_source_must_exist_and_options_must_agree(
    parent: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    missing = tmp_path / "nothing"
    assert "no trained model" in sentence(["train", "quick", "--from", str(missing)], capsys)
    words = ["train", "--from", str(parent.path), "--imitation.dataset", "a/b-v0"]
    assert "either" in sentence([*words[:1], "quick", *words[1:]], capsys)
    resume = ["train", "--resume", str(parent.path)]
    assert "--from" in sentence([*resume, "--training.timesteps", "4096"], capsys)
    assert "--from" in sentence([*resume, "--from", str(parent.path)], capsys)
    assert "arkanoid train --from" in sentence(resume, capsys)


def test_a_run_with_a_start_is_reproduced_without_the_other_run(
    child: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    received = RunFolder(tmp_path / "received")
    shutil.copytree(child.path, received.path)
    assert cli.main(["reproduce", str(received.path)]) == 0
    out = capsys.readouterr().out
    assert "the same, bit for bit" in out
    assert "It began with the weights of" in out
    assert "2,048 decisions" in out
    received.start.unlink()
    assert "start.zip: missing" in sentence(["reproduce", str(received.path)], capsys)


def test_another_start_than_that_of_the_notes_is_noticed(
    child: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    received = RunFolder(tmp_path / "received")
    shutil.copytree(child.path, received.path)
    shutil.copy(child.model, received.start)
    assert "run.json" in sentence(["reproduce", str(received.path)], capsys)


def test_forged_counts_are_not_believed(child: RunFolder, tmp_path: Path) -> None:
    """The number of decisions is read from the model's file, which may be anyone's."""
    forged = tmp_path / "forged.zip"
    with zipfile.ZipFile(child.model) as source, zipfile.ZipFile(forged, "w") as target:
        for name in source.namelist():
            content = source.read(name)
            if name == "data":
                content = json.dumps({"num_timesteps": 10**30}).encode()
            target.writestr(name, content)
    words = settings(tmp_path / "runs", **{"training.timesteps": "256"})
    assert cli.main(["train", "quick", "--from", str(forged), *words]) == 0
    assert newest(tmp_path / "runs").read_notes()["lineage"]["decisions"] == 0


def test_a_report_tells_what_a_run_began_with(child: RunFolder, tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    assert cli.main(["report", str(child.path), "--out", str(page)]) == 0
    text = page.read_text(encoding="utf-8")
    assert "It began with the weights of" in text
    assert "2,048 decisions" in text
