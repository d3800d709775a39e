"""Absurd sizes, trainings that diverge and full disks: a sentence, and no traceback."""

import errno
import io
import sys
import tomllib
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from arkanoid.agents import cli
from arkanoid.agents.experiment import files
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.reading import read_toml
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.learn.curves import read_curve
from arkanoid.agents.learn.tensors import read_entry, read_tensors
from arkanoid.agents.learn.training import train
from helpers.processes import run_program
from helpers.runs import SMALL, packaged_copy, sentence, small

# Absurd sizes


@pytest.mark.parametrize(
    ("setting", "value", "word"),
    [
        ("training.worlds", "1_000_000_000_000", "at most 1000000"),
        ("training.worlds", "9" * 5000, "training.worlds"),
        ("training.timesteps", "9" * 40, "at most"),
        ("ppo.n_steps", "1_000_000", "GiB"),
        ("ppo.n_steps", "1_000_000_000", "at most"),
        ("network.hidden", "[1_000_000_000]", "at most 16384"),
        ("network.hidden", str([16_384] * 32), "GiB"),
        ("network.hidden", str([1] * 1000), "at most 32 layers"),
        ("training.torch_threads", "1_000_000", "at most 1024"),
        ("validation.levels", '["seeds:0-999_999_999_999"]'.replace("_", ""), "levels"),
        ("validation.levels", '["seeds:0-9000"]', "memory"),
        ("name", '"a\\u001b]0;x"', "'name'"),
    ],
)
def test_absurd_sizes_get_a_sentence(
    setting: str, value: str, word: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    settings = {"validation.every": "1000", "validation.episodes": "1000000", setting: value}
    settings["output"] = str(tmp_path)
    arguments = ["train", "quick", *(f"--{key}={text}" for key, text in settings.items())]
    assert word in sentence(arguments, capsys)


def test_a_training_that_diverges_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    settings = {**SMALL, "ppo.learning_rate": "1e30", "output": str(tmp_path)}
    arguments = ["train", "quick", *(f"--{key}={text}" for key, text in settings.items())]
    assert "diverged" in sentence(arguments, capsys)


@pytest.mark.parametrize("seconds", ["inf", "nan", "-inf", "0"])
def test_a_film_without_end_is_refused(seconds: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert "--seconds" in sentence(["film", "x.gif", f"--seconds={seconds}"], capsys)


def test_a_film_of_a_great_length_ends_with_the_game(tmp_path: Path) -> None:
    arguments = ["film", str(tmp_path / "x.gif"), "--seconds", "1e300"]
    assert cli.main([*arguments, "--env.max_decisions", "20"]) == 0


@pytest.mark.parametrize("kind", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_a_model_that_python_would_unpack_without_a_limit_is_refused(
    kind: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """24 kilobytes took 6.5 GB: the limit was compared afterwards."""
    run = packaged_copy(tmp_path / "received")
    with zipfile.ZipFile(run.model, "w", kind) as archive:
        archive.writestr("policy.pth", bytes(10_000_000))
    assert "policy.pth is packed in an unknown way" in sentence(["evaluate", str(run.path)], capsys)
    with pytest.raises(ValueError, match="packed in an unknown way"):
        read_tensors(run.model.read_bytes())


def test_a_deflated_file_is_unpacked_up_to_the_limit() -> None:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("zeros", bytes(50_000_000))
    with zipfile.ZipFile(buffer) as archive:
        tracemalloc.start()
        with pytest.raises(ValueError, match="larger than 1,000 bytes"):
            read_entry(archive, "zeros", 1000)
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert most < 1_000_000
        assert read_entry(archive, "zeros", 50_000_000) == bytes(50_000_000)


@pytest.mark.parametrize(
    "text",
    [
        "a" + ".a" * 500_000 + " = 1",
        "[a" + " . 'a'" * 150_000 + "]",
        "x = {a" + '."a, # [a" ' * 90_000 + " = 1}",
        'x = {y = """\\""" \' # """, a' + ".a" * 400_000 + " = 1}",
        "x = " + "[" * 500_000,
        "x = " + "{a = " * 150_000,
        'x = "' + '\\"' * 500_000,
        'x = """' + '\\"""' * 200_000,
    ],
    ids=["dots", "table", "quoted", "hidden", "lists", "tables", "text", "lines"],
)
def test_a_hostile_config_is_refused_at_once(
    text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Half a million dots would have kept the reader of TOML busy for days."""
    config = tmp_path / "config.toml"
    config.write_text(text)
    assert "not a TOML file" in sentence(["train", str(config)], capsys)


@pytest.mark.parametrize(
    "text",
    [
        'a = "' + "b." * 20 + '"\nc.d = 1.5 # ' + "e." * 20,
        "a = '" + "b." * 20 + '\' # \' " """\nc.d = 1',
        'a = """\n' + "b." * 20 + '\\""" " """""\nc.d = 1',
        "a = '''\n" + "b." * 20 + "'' \\'''''\nc.d = 1",
        "a = [" + "1.5, " * 20 + "]\n" + "".join(f"c.d{index} = 1\n" for index in range(20)),
    ],
)
def test_dots_in_texts_comments_and_numbers_are_not_counted(text: str, tmp_path: Path) -> None:
    config = tmp_path / "config.toml"
    config.write_text(text)
    assert read_toml(str(config))[1] == tomllib.loads(text)


def test_a_film_of_the_longest_game_is_written(tmp_path: Path) -> None:
    """Tick by tick the game would last longer than a game may: a ValueError and a traceback."""
    arguments = ["film", str(tmp_path / "x.mp4"), "--seconds", "0.2"]
    assert cli.main([*arguments, "--env.max_decisions", "1000000000000"]) == 0


# Full disks


def fill(monkeypatch: pytest.MonkeyPatch, suits: Callable[[str], bool], after: int = 0) -> None:
    """Let the disk be full from a certain write of files with suitable names on."""
    whole, written = files.os.fsync, 0

    def fsync(descriptor: int) -> None:
        nonlocal written
        # Linux tells the name of an open file.
        written += suits(str(Path(f"/proc/self/fd/{descriptor}").resolve()))
        if written > after:
            raise OSError(errno.ENOSPC, "No space left on device")
        whole(descriptor)

    monkeypatch.setattr(files.os, "fsync", fsync)


@pytest.mark.skipif(sys.platform != "linux", reason="looks up the names of open files")
def test_a_full_disk_says_how_to_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    experiment = small(tmp_path / "runs and more")
    run = RunFolder.create(experiment)
    with monkeypatch.context() as patch:
        fill(patch, lambda name: name.endswith("checkpoint.pt"), after=2)
        with pytest.raises(SettingsError) as caught:
            train(experiment, run)
    assert "the disk is full" in str(caught.value)
    # Ready for the shell: the folder has a space in its name.
    assert f"arkanoid train --resume '{run.path}'" in str(caught.value)
    assert not list(run.path.glob("unfinished-*"))
    assert cli.main(["train", "--resume", str(run.path)]) == 0
    assert run.read_notes()["outcome"] == "finished"


@pytest.mark.skipif(sys.platform != "linux", reason="looks up the names of open files")
def test_a_disk_that_is_full_from_the_beginning_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    experiment = small(tmp_path)
    run = RunFolder.create(experiment)
    with monkeypatch.context() as patch:
        fill(patch, lambda name: name.endswith("checkpoint.pt"))
        with pytest.raises(SettingsError, match="the disk is full before the first checkpoint"):
            train(experiment, run)
    assert not list(run.path.glob("unfinished-*"))


@pytest.mark.skipif(sys.platform != "linux", reason="looks up the names of open files")
def test_a_disk_that_is_full_at_the_very_end_costs_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The resumed run has nothing left to learn, and measures nothing twice."""
    experiment = small(tmp_path, **{"validation.every": "1024", "validation.episodes": "1"})
    whole, run = RunFolder.create(experiment), RunFolder.create(experiment)
    train(experiment, whole)
    with monkeypatch.context() as patch:
        fill(patch, lambda name: name.endswith("model.zip"))
        with pytest.raises(SettingsError, match="the disk is full"):
            train(experiment, run)
    assert train(experiment, run, resumed=True) == "finished"
    assert run.read_notes()["weights"] == whole.read_notes()["weights"]
    assert [row["timesteps"] for row in read_curve(run.curve)] == [
        row["timesteps"] for row in read_curve(whole.curve)
    ]


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of a file's size there")
def test_a_disk_that_is_really_full_stops_a_training_with_one_sentence(tmp_path: Path) -> None:
    """The system itself refuses, be it the curves, TensorBoard's thread or the checkpoint."""
    settings = {**SMALL, "training.timesteps": "1_000_000", "output": str(tmp_path)}
    words = ["train", "quick", *(f"--{key}={value}" for key, value in settings.items())]
    program = (
        "import resource, signal, sys; from arkanoid.agents.cli import main\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (90_000, 90_000))\n"
        "sys.exit(main(sys.argv[1:]))"
    )
    done = run_program(program, *words, warnings="default", status=2)
    assert "Traceback" not in done.stderr
    (path,) = tmp_path.iterdir()
    assert done.stderr.count("arkanoid: error: ") == 1
    assert f"arkanoid train --resume {path}" in done.stderr
    assert not list(path.glob("unfinished-*"))
