"""Damaged files, and two processes at once on one run: a sentence, and no traceback."""

import contextlib
import json
import math
import random
import re
import shutil
import signal
import subprocess
import sys
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import torch
from arkanoid.agents import cli
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.provenance import weights_hash
from arkanoid.agents.experiment.runs import INTERRUPTED, ModelFile, RunFolder
from arkanoid.agents.learn import training
from arkanoid.agents.learn.callbacks import ProgressBar
from arkanoid.agents.learn.checkpoints import read_checkpoint, write_checkpoint
from arkanoid.agents.learn.curves import read_curve
from arkanoid.agents.learn.model import load_policy
from arkanoid.agents.learn.search.space import load_space
from arkanoid.agents.learn.search.study import open_study
from arkanoid.agents.learn.tensors import read_tensors
from arkanoid.agents.learn.training import train
from helpers.runs import SMALL, sentence, small


@contextlib.contextmanager
def stopped_at(timesteps: int) -> Any:
    """Press Ctrl-C in the middle of a training."""

    class Stop(ProgressBar):
        def _on_step(self) -> bool:
            if self.model.num_timesteps == timesteps:
                signal.raise_signal(signal.SIGINT)
            return super()._on_step()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(training, "ProgressBar", Stop)
        yield


@pytest.fixture(scope="module")
def stopped(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    """A run that was stopped in the middle of a rollout."""
    experiment = small(tmp_path_factory.mktemp("stopped"))
    run = RunFolder.create(experiment)
    with stopped_at(1000):
        assert train(experiment, run) == INTERRUPTED
    return run


@pytest.fixture
def run(stopped: RunFolder, tmp_path: Path) -> RunFolder:
    """A copy of it."""
    shutil.copytree(stopped.path, tmp_path / "run")
    return RunFolder(tmp_path / "run")


def test_a_reproduction_that_is_stopped_says_so(
    run: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    """It ended without a word, and left a folder that looks like a run."""
    run.add_notes(weights="0" * 64)
    with stopped_at(512):
        assert cli.main(["reproduce", str(run.path)]) == 130
    _, again = sorted(run.path.parent.iterdir())
    assert f"nothing needs {again}" in capsys.readouterr().out


# Two processes


def test_two_at_once_on_one_run_is_a_mistake(
    run: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two that resumed one run wrote into the same curve, and the last one's model stayed."""
    arguments = ["train", "--resume", str(run.path)]
    with run.locked():
        error = sentence(arguments, capsys)
    assert "another process is training this run" in error
    assert str(run.path) in error
    other = subprocess.Popen(
        [sys.executable, "-c", HOLDER, run.path], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert other.stdout is not None
    assert other.stdout.readline().strip() == b"locked"
    assert "another process" in sentence(arguments, capsys)
    # A killed process holds no lock.
    other.kill()
    other.communicate()
    assert cli.main(arguments) == 0
    assert "nothing to resume" in sentence(arguments, capsys)


HOLDER = """
import sys
from pathlib import Path
from arkanoid.agents.experiment.runs import RunFolder
with RunFolder(Path(sys.argv[1])).locked():
    print("locked", flush=True)
    input()
"""


# Curves


def test_a_resumed_run_writes_the_curve_of_the_run_that_was_not_stopped(
    run: RunFolder, tmp_path: Path
) -> None:
    """Once 12 of 19 values of the last update before the checkpoint were missing."""
    experiment = small(tmp_path)
    whole = RunFolder.create(experiment)
    train(experiment, whole)
    train(run.experiment(), run, resumed=True)

    def curve(of: RunFolder) -> list[dict[str, Any]]:
        rows = read_curve(of.curve)
        return [
            {key: value for key, value in row.items() if not key.startswith("time/")}
            for row in rows
        ]

    assert curve(run) == curve(whole)
    assert sum("train/loss" in row for row in curve(run)) == 7
    assert run.read_notes()["weights"] == whole.read_notes()["weights"]


# Damaged files


def forged_notes() -> list[bytes]:
    return [
        b"",
        b"{",
        b"[]",
        b"3",
        b'{"outcome": 3}',
        b'{"sessions": 3}',
        b'{"sessions": [3]}',
        b'{"sessions": [{"seconds": "x"}]}',
        b'{"versions": [1]}',
        b'{"timesteps": true}',
        b"\xff\xfe",
        b"[" * 100_000,
        b" " * (2**20 + 1),
    ]


@pytest.mark.parametrize("content", forged_notes(), ids=lambda content: repr(content[:30]))
def test_damaged_notes_are_named(
    content: bytes, run: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    run.notes.write_bytes(content)
    for arguments in (["train", "--resume"], ["reproduce"]):
        error = sentence([*arguments, str(run.path)], capsys)
        assert str(run.notes) in error
        assert "remove it" in error
    with pytest.raises(SettingsError, match="damaged"):
        run.add_notes(outcome="x")


def test_a_run_goes_on_without_its_notes(run: RunFolder) -> None:
    run.notes.unlink()
    assert cli.main(["train", "--resume", str(run.path)]) == 0
    assert run.read_notes()["outcome"] == "finished"


@pytest.mark.parametrize(
    "content",
    [b"", b"\xff", b"seed = 99999999999999999999999", b"seed = " + b"9" * 5000, b"x" * 2**21],
    ids=lambda content: repr(content[:30]),
)
def test_a_damaged_config_is_named(
    content: bytes, run: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    run.config.write_bytes(content)
    if content:
        for arguments in (["evaluate"], ["reproduce"], ["train", "--resume"]):
            run.add_notes(weights="x")
            assert str(run.config) in sentence([*arguments, str(run.path)], capsys)
    else:  # the default experiment, with another network
        assert str(run.model) in sentence(["evaluate", str(run.path)], capsys)
        assert str(run.checkpoint) in sentence(["train", "--resume", str(run.path)], capsys)


@pytest.mark.parametrize(
    "line",
    [
        b"",
        b"{",
        b"3",
        b"{}",
        b'{"timesteps": "3"}',
        b'{"timesteps": 3, "x": []}',
        b"\xff",
        b'{"timesteps": 3, "x": 1%s}' % (b"0" * 400),
    ],
)
def test_a_damaged_line_of_a_curve_is_named_unless_it_is_the_last(
    line: bytes, run: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    """Once such a line raised an exception, or all lines after it were silently dropped."""
    first, *rest = run.curve.read_bytes().splitlines(keepends=True)
    run.curve.write_bytes(b"".join([first, line + b"\n", *rest]))
    error = sentence(["train", "--resume", str(run.path)], capsys)
    assert str(run.curve) in error
    assert "line 2 " in error
    for end in (b"\n", b""):
        run.curve.write_bytes(first + line + end)
        assert read_curve(run.curve) == [json.loads(first)]


def damage(content: bytes, number: int) -> bytes:
    """Return content that was cut, or of which some bytes were changed."""
    draw = random.Random(number)
    if number % 3 == 0:
        return content[: draw.randrange(len(content))]
    changed = bytearray(content)
    for _ in range(draw.choice([1, 1, 20])):
        changed[draw.randrange(len(changed))] = draw.randrange(256)
    return bytes(changed)


def test_a_damaged_checkpoint_is_named_or_is_the_same(
    run: RunFolder, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    content = run.checkpoint.read_bytes()
    path = tmp_path / "damaged.pt"
    refused = 0
    for number in range(300):
        path.write_bytes(damage(content, number))
        try:
            read_checkpoint(path)
        except SettingsError as error:
            assert str(path) in str(error)  # noqa: PT017
            refused += 1
    # Not all bytes of a zip file count.
    assert refused > 250


def test_damaged_weights_are_named_or_are_the_same(run: RunFolder, tmp_path: Path) -> None:
    with zipfile.ZipFile(run.model) as archive:
        content = archive.read("policy.pth")
    expected = read_tensors(content)
    refused = 0
    for number in range(300):
        try:
            weights = read_tensors(damage(content, number))
        except ValueError:
            refused += 1
        else:
            assert weights.keys() == expected.keys()
            assert all(torch.equal(weights[name], expected[name]) for name in expected)
    assert refused > 250


def test_a_damaged_model_is_named_or_plays_the_same(run: RunFolder) -> None:
    content, experiment = run.model.read_bytes(), run.experiment()
    refused = 0
    expected = weights_hash(
        load_policy(ModelFile(run, run.model), experiment)._network.state_dict()
    )  # type: ignore[attr-defined]
    for number in range(200):
        run.model.write_bytes(damage(content, number))
        try:
            policy: Any = load_policy(ModelFile(run, run.model), experiment)
        except SettingsError as error:
            assert str(run.model) in str(error)  # noqa: PT017
            refused += 1
        else:
            assert weights_hash(policy._network.state_dict()) == expected
    assert refused > 100


def leaves(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the paths to all values in nested tables and lists."""
    if isinstance(value, dict):
        return [path, *(way for key in value for way in leaves(value[key], (*path, key)))]
    if isinstance(value, list) and len(value) < 20:
        return [path, *(way for at, one in enumerate(value) for way in leaves(one, (*path, at)))]
    return [path]


OTHERS = [None, -1, 10**30, math.nan, "x", [], {}, [[1]], {"x": "y"}, torch.zeros(2, 2)]


def test_a_checkpoint_of_wrong_values_is_named_or_goes_on(run: RunFolder) -> None:
    """Every value in turn is replaced by another one, in a file that is not damaged otherwise."""
    state = read_checkpoint(run.checkpoint)
    ways = leaves(state)[1:]
    training = replace(run.experiment().training, timesteps=1280)
    experiment = replace(run.experiment(), training=training)
    assert len(ways) > 60
    draw = random.Random(0)
    refused = 0
    for way in ways:
        changed = read_checkpoint(run.checkpoint)
        *path, last = way
        table: Any = changed
        for key in path:
            table = table[key]
        table[last] = draw.choice(OTHERS)
        write_checkpoint(changed, run.checkpoint)
        run.add_notes(outcome="interrupted")
        try:
            train(experiment, run, resumed=True)
        except SettingsError as error:
            assert str(run.path) in str(error)  # noqa: PT017
            refused += 1
        write_checkpoint(state, run.checkpoint)
    assert refused > len(ways) // 2


def test_a_checkpoint_of_another_network_is_named(
    run: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    text, count = re.subn(r"hidden = \[\s*8,?\s*\]", "hidden = [9]", run.config.read_text())
    assert count == 1
    run.config.write_text(text)
    before = run.curve.read_bytes()
    error = sentence(["train", "--resume", str(run.path)], capsys)
    assert str(run.checkpoint) in error
    assert "policy" in error
    # Nothing was changed: with the right settings the run can go on.
    assert run.curve.read_bytes() == before


@pytest.mark.parametrize("content", [b"", b"{}\n{}\n", b"\xff\n\xff\n", b'{"op_code": 99}\n3\n'])
def test_a_damaged_study_is_named(
    content: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    journal = tmp_path / "study.journal"
    journal.write_bytes(content)
    space = load_space("ppo")
    if not content:
        assert open_study(tmp_path, space, 0).trials == []
        return
    arguments = ["tune", "quick", "--study", str(tmp_path)]
    error = sentence(arguments, capsys)
    assert str(journal) in error
    assert "remove it" in error


def test_a_message_holds_nothing_that_a_terminal_obeys(
    run: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    text = run.config.read_text().replace('"ArkanoidLite-v0"', '"No\\u001b]0;x\\u0007\\nSuch-v0"')
    run.config.write_text(text)
    error = sentence(["evaluate", str(run.path)], capsys)
    assert error.isprintable()
    assert r"No\x1b]0;x\x07" in error


def test_a_study_of_another_space_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    space = tmp_path / "space.toml"
    settings = {**SMALL, "validation.episodes": "1"}
    del settings["training.timesteps"]
    arguments = ["tune", "quick", "--space", str(space), "--study", str(tmp_path / "study")]
    arguments += ["--budget", "0.3", "--jobs", "1"]
    arguments += [f"--{key}={value}" for key, value in settings.items()]
    space.write_text('[parameters]\n"ppo.gamma" = {choices = [0.9]}\n')
    assert cli.main([*arguments, "--trials", "1"]) == 0
    space.write_text('[parameters]\n"ppo.gamma" = {choices = [0.8, 0.7]}\n')
    assert "another space" in sentence([*arguments, "--trials", "2"], capsys)
    space.write_text('[parameters]\n"ppo.ent_coef" = {choices = [0.1]}\n')
    assert "another space" in sentence([*arguments, "--trials", "1"], capsys)
