"""Runs from other people: no command runs code in them, unless the user trusts them.

Once every command that loads a model unpickled it, and a forged file ran a shell command.
"""

import base64
import io
import json
import os
import pickle
import random
import shutil
import struct
import sys
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from arkanoid.agents import cli
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.experiment.settings import load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.learn.model import load_policy, make_model, save_model
from arkanoid.agents.learn.tensors import read_tensors, write_tensors
from arkanoid.agents.measure.episodes import adapt
from arkanoid.envs.play import show, window
from helpers.runs import packaged_copy
from stable_baselines3 import PPO

# Every command that reads a model, with little to play.
SHORT = ["--env.max_decisions", "20"]
QUICK = ["--evaluation.episodes", "1", "--evaluation.suites", '["games"]']
QUICK += ["--evaluation.baselines", "[]", *SHORT]
COMMANDS = {
    "evaluate": ["evaluate", "RUN", "--json", *QUICK],
    "film": ["film", "RUN", "OUT.gif", "--seconds", "0.2", *SHORT],
    "watch": ["watch", "RUN", *SHORT],
    "report": ["report", "RUN", "--out", "OUT.html", *QUICK],
}
# Every command that reads a run's settings.
READERS = {
    **COMMANDS,
    "resume": ["train", "--resume", "RUN"],
    "reproduce": ["reproduce", "RUN"],
    "from": ["train", "--from", "RUN"],
    "dataset": ["dataset", "arkanoid/received-v0", "RUN"],
}


class Command:
    """An object of a forged pickle: unpickling it runs a command."""

    def __init__(self, marker: Path) -> None:
        self._marker = marker

    def __reduce__(self) -> tuple[Callable[[str], int], tuple[str]]:
        return os.system, (f"\"{sys.executable}\" -c \"open(r'{self._marker}', 'w')\"",)


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> RunFolder:
    """A received copy of the packaged run; windows close at once."""
    received = packaged_copy(tmp_path / "received")
    monkeypatch.setitem(os.environ, "SDL_VIDEODRIVER", "dummy")

    class Show(window.Window):
        def show(self, frame: np.ndarray) -> bool:
            self.close()
            return False

    monkeypatch.setattr(show, "Window", Show)
    return received


def words(command: list[str], run: RunFolder) -> list[str]:
    out = str(run.path.parent / "out")
    return [word.replace("RUN", str(run.path)).replace("OUT", out) for word in command]


def change(path: Path, **entries: bytes) -> None:
    """Replace files in a zip file."""
    with zipfile.ZipFile(path) as archive:
        content = {name: archive.read(name) for name in archive.namelist()}
    assert entries.keys() <= content.keys()
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in {**content, **entries}.items():
            archive.writestr(name, data)


def forge_settings(run: RunFolder, marker: Path) -> None:
    """Forge the entry that stable-baselines3 unpickles first, and keep the weights."""
    with zipfile.ZipFile(run.model) as archive:
        data = json.loads(archive.read("data"))
    data["policy_class"][":serialized:"] = base64.b64encode(pickle.dumps(Command(marker))).decode()
    change(run.model, data=json.dumps(data).encode())


def forge_weights(run: RunFolder, marker: Path) -> None:
    buffer = io.BytesIO()
    torch.save({"weights": Command(marker)}, buffer)
    change(run.model, **{"policy.pth": buffer.getvalue()})


@pytest.mark.parametrize("command", COMMANDS)
def test_a_forged_entry_of_a_model_is_not_even_read(
    command: str, run: RunFolder, tmp_path: Path
) -> None:
    marker = tmp_path / "was run"
    forge_settings(run, marker)
    assert cli.main(words(COMMANDS[command], run)) == 0
    assert not marker.exists()
    # The forged entry works: --trust runs it.
    assert cli.main([*words(COMMANDS[command], run), "--trust"]) in (0, 2)
    assert marker.exists()


@pytest.mark.parametrize("command", COMMANDS)
def test_weights_that_are_a_program_are_refused(
    command: str, run: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    marker = tmp_path / "was run"
    forge_weights(run, marker)
    assert cli.main(words(COMMANDS[command], run)) == 2
    assert not marker.exists()
    error = capsys.readouterr().err.splitlines()[-1]
    assert str(run.model) in error
    assert "--trust" in error
    with zipfile.ZipFile(run.model) as archive:
        torch.load(io.BytesIO(archive.read("policy.pth")), weights_only=False)
    assert marker.exists()


@pytest.mark.parametrize("trust", [[], ["--trust"]])
def test_a_training_begins_with_numbers_only(
    trust: list[str], run: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Neither a run's model nor a lone file is unpickled, also not with --trust."""
    marker = tmp_path / "was run"
    forge_weights(run, marker)
    lone = shutil.copy(run.model, tmp_path / "lone.zip")
    for words in (["--from", str(run.path)], ["lite", "--from", str(lone)]):
        assert cli.main(["train", *words, *trust, "--output", str(tmp_path / "runs")]) == 2
        assert "same network" in capsys.readouterr().err
    assert not marker.exists()
    assert not (tmp_path / "runs").exists()


def test_a_checkpoint_that_is_a_program_is_refused(
    run: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    marker = tmp_path / "was run"
    run.add_notes(outcome="interrupted")
    torch.save({"format": 2, "policy": Command(marker)}, run.checkpoint)
    for trust in ([], ["--trust"]):
        assert cli.main(["train", "--resume", str(run.path), *trust]) == 2
        assert str(run.checkpoint) in capsys.readouterr().err
        assert not marker.exists()


@pytest.mark.parametrize("command", READERS)
def test_a_module_that_a_received_config_names_is_not_imported(
    command: str,
    run: RunFolder,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    marker = tmp_path / "was run"
    (tmp_path / "somebodys.py").write_text(f"open(r'{marker}', 'w').close()\nimport arkanoid\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "somebodys", raising=False)
    text = run.config.read_text().replace('"ArkanoidLite-v0"', '"somebodys:ArkanoidLite-v0"')
    run.config.write_text(text)
    run.add_notes(outcome="interrupted")
    assert cli.main(words(READERS[command], run)) == 2
    error = capsys.readouterr().err
    assert "'somebodys'" in error
    assert "--trust" in error
    assert error.count("\n") == 1
    assert not marker.exists()
    if command == "evaluate":
        assert cli.main([*words(READERS[command], run), "--trust"]) == 0
        assert marker.exists()


def test_an_experiment_of_ones_own_may_name_a_module(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Naming a configuration to train from, or typing the id, is consent."""
    (tmp_path / "mine.py").write_text("import arkanoid\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    small = ["--training.timesteps", "512", "--training.worlds", "4", "--ppo.n_steps", "64"]
    small += ["--ppo.batch_size", "256", "--evaluation.film_seconds", "0.2", *QUICK]
    output = ["--output", str(tmp_path / "runs")]
    arguments = ["train", "quick", *small, *output, "--env_id", "mine:ArkanoidLite-v0"]
    assert cli.main(arguments) == 0
    (path,) = (tmp_path / "runs").iterdir()
    with pytest.raises(SettingsError, match="imports the module 'mine'"):
        RunFolder(path).experiment()
    assert RunFolder(path, trusted=True).experiment().env_id == "mine:ArkanoidLite-v0"


@pytest.mark.parametrize(
    "settings",
    [
        {"network.features": "flat"},
        {"network.features": "lattice"},
        {"network.features": "landing", "env.landing": "true"},
        {"network.features": "flat", "network.hidden": "[]"},
        {"env.observation": "grid", "network.features": "auto", "network.activation": "relu"},
        {"env.observation": "rgb", "env.size": "48", "network.features": "planes"},
        {"env.observation": "rgb", "network.features": "nature", "env.stack": "2"},
        {"env_id": "Arkanoid-v0", "env.actions": "box", "network.features": "flat"},
    ],
    ids=lambda settings: " ".join(settings.values()),
)
@pytest.mark.parametrize("deterministic", [True, False])
def test_the_rebuilt_network_plays_as_the_unpickled_one(
    settings: dict[str, str], deterministic: bool, tmp_path: Path
) -> None:
    choice = ("evaluation.deterministic", str(deterministic).lower())
    # Only vectors have landings.
    plain = [("env.landing", "false"), ("ppo.batch_size", "512")]
    words = [*plain, *settings.items(), ("output", str(tmp_path)), choice]
    experiment = load_experiment("quick", words)
    run = RunFolder.create(experiment)
    worlds = make_worlds(experiment, 16)
    model = make_model(experiment, adapt(worlds))
    with torch.no_grad():  # as large as after a training
        for weight in model.policy.parameters():
            weight += torch.empty_like(weight).uniform_(-0.2, 0.2)
    save_model(model, run.model, run.experiment())
    received = ModelFile.find(str(run.path))
    rebuilt = load_policy(received, experiment)
    unpickled = load_policy(replace(received, run=run), experiment)
    assert run.trusted
    assert not received.run.trusted
    observations, _ = worlds.reset(seed=1)
    everyone = np.arange(16)
    ours, theirs = rebuilt._network, unpickled._network  # type: ignore[attr-defined]
    for _ in range(20):
        actions = unpickled(observations, everyone)
        np.testing.assert_array_equal(rebuilt(observations, everyone), actions)
        # The numbers behind the choice are the same, too.
        seen, chosen = torch.as_tensor(observations), torch.as_tensor(actions)
        with torch.no_grad():
            numbers = [policy.evaluate_actions(seen, chosen) for policy in (ours, theirs)]
        for one, other in zip(*numbers, strict=True):
            assert torch.equal(one, other)
        observations, *_ = worlds.step(actions)
    worlds.close()


def test_building_a_network_draws_no_random_number(run: RunFolder) -> None:
    before = torch.random.get_rng_state()
    load_policy(ModelFile.find(str(run.path)), run.experiment())
    assert torch.equal(torch.random.get_rng_state(), before)


def test_each_model_has_the_network_of_its_own_run(
    run: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = load_experiment(str(run.config), [("network.hidden", "[8]"), ("output", str(tmp_path))])
    small = RunFolder.create(other)
    save_model(make_model(other, adapt(make_worlds(other, 64))), small.model, other)
    assert cli.main(["evaluate", str(run.path), str(small.path), "--json", *QUICK]) == 0
    assert set(json.loads(capsys.readouterr().out)["models"]) == {"lite", "lite#2"}


def weights_of(run: RunFolder) -> dict[str, Any]:
    state: dict[str, Any] = PPO.load(run.model, device="cpu").policy.state_dict()
    return state


@pytest.mark.parametrize(
    ("forged", "message"),
    [
        (lambda state: [1, 2], "another network"),
        (lambda state: {**state, "more": torch.zeros(1)}, "another network"),
        (lambda state: {name: value[:1] for name, value in state.items()}, "another network"),
        (lambda state: {name: value.int() for name, value in state.items()}, "another network"),
        (lambda state: dict.fromkeys(state, 0.5), "another network"),
        # A single number that looks like a whole tensor.
        (
            lambda state: {name: torch.zeros(1).expand(v.shape) for name, v in state.items()},
            "another network",
        ),
        (lambda state: {name: value * torch.nan for name, value in state.items()}, "not finite"),
        (lambda state: {**state, "more": torch.zeros(1_000_000)}, "larger than"),
    ],
)
def test_other_weights_are_refused(
    forged: Callable[[dict[str, Any]], Any],
    message: str,
    run: RunFolder,
    capsys: pytest.CaptureFixture[str],
) -> None:
    change(run.model, **{"policy.pth": bytes(write_tensors(forged(weights_of(run))))})
    assert cli.main(words(COMMANDS["evaluate"], run)) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1


def test_a_network_whose_numbers_overflow_is_named(
    run: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    state = {name: torch.full_like(value, 3e38) for name, value in weights_of(run).items()}
    change(run.model, **{"policy.pth": bytes(write_tensors(state))})
    assert cli.main(words(COMMANDS["evaluate"], run)) == 2
    assert "the model cannot play" in capsys.readouterr().err


def test_a_file_that_swells_as_it_is_unpacked_is_refused() -> None:
    """A megabyte of zeros is a kilobyte in a zip file."""
    buffer = io.BytesIO()
    torch.save({"zeros": torch.zeros(1_000_000)}, buffer)
    swelling = io.BytesIO()
    with (
        zipfile.ZipFile(buffer) as plain,
        zipfile.ZipFile(swelling, "w", zipfile.ZIP_DEFLATED) as packed,
    ):
        for name in plain.namelist():
            packed.writestr(name, plain.read(name))
    assert len(swelling.getvalue()) < 10_000
    with pytest.raises(ValueError, match="larger than"):
        read_tensors(swelling.getvalue())


def test_a_zip_file_that_lies_about_its_sizes_is_refused() -> None:
    content = bytearray(write_tensors({"ones": torch.ones(1000)}))
    # The size of the largest file, in the directory at the end.
    place = content.index(struct.pack("<II", 4000, 4000), content.rindex(b"PK\x01\x02") - 400)
    content[place : place + 8] = struct.pack("<II", 40, 40)
    with pytest.raises(ValueError, match=r"\w"):
        read_tensors(bytes(content))


@pytest.mark.parametrize(
    "value",
    [bytearray(3), torch.Size([3]), torch.zeros(3, dtype=torch.complex64), {1, 2}, b"bytes", 1j],
    ids=lambda value: type(value).__name__,
)
def test_what_is_no_number_text_list_or_table_is_not_read(value: Any) -> None:
    """The reader of torch would carry out `bytearray(10**12)`, and so fill the memory."""
    buffer = io.BytesIO()
    torch.save(value, buffer)
    with pytest.raises(ValueError, match="more than numbers"):
        read_tensors(buffer.getvalue())


def test_forged_programs_with_right_checksums_are_refused_or_harmless(run: RunFolder) -> None:
    """Bytes are changed, removed and inserted; the only exception is ValueError."""
    with zipfile.ZipFile(run.model) as archive, archive.open("policy.pth") as file:
        inner = zipfile.ZipFile(io.BytesIO(file.read()))
    entries = {name: inner.read(name) for name in inner.namelist()}
    (program,) = (name for name in entries if name.endswith(".pkl"))
    draw = random.Random(0)
    outcomes: set[str] = set()
    for _ in range(500):
        changed = bytearray(entries[program])
        place, length = draw.randrange(len(changed)), draw.randrange(4)
        changed[place : place + draw.randrange(4)] = draw.randbytes(length)
        forged = io.BytesIO()
        with zipfile.ZipFile(forged, "w") as archive:
            for name, content in {**entries, program: bytes(changed)}.items():
                archive.writestr(name, content)
        try:
            read_tensors(forged.getvalue())
        except ValueError:
            outcomes.add("refused")
        else:
            outcomes.add("read")
    assert outcomes == {"refused", "read"}


def test_numbers_come_back_as_they_were() -> None:
    value = {
        "numbers": [1, -(2**70), 0.1, float("inf"), True, None],
        "text": ("é\n", {3: "x"}),
        "tensors": [torch.arange(6).reshape(2, 3), torch.zeros(0), torch.tensor([True])],
    }
    again = read_tensors(bytes(write_tensors(value)))
    for ours, theirs in zip(again.pop("tensors"), value.pop("tensors"), strict=True):  # type: ignore[arg-type]
        assert torch.equal(ours, theirs)
        assert ours.dtype == theirs.dtype
    assert again == value
