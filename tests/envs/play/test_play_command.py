"""The command `arkanoid play`: what it saves, and its error messages."""

import errno
import shlex
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from arkanoid.agents import cli
from arkanoid.agents.commands.play import free_path
from arkanoid.envs.batch.playback import play_replay, replay_states
from arkanoid.envs.batch.replays import Replay
from arkanoid.envs.play.controls import Key
from arkanoid.envs.play.sitting import Phase, Sitting
from helpers.processes import run_program
from helpers.sittings import post, tap


def after(ticks: int, deed: Callable[[Any], object]) -> Callable[[Any], None]:
    """A method `tick` that starts the game, and does a deed after so many ticks."""
    original = Sitting.tick

    def tick(self: Any) -> None:
        if self.phase is Phase.READY:
            tap(self, Key.FIRE)
        original(self)
        if self.world.decisions == ticks:
            deed(self)

    return tick


@pytest.mark.parametrize(
    ("deed", "status"),
    [
        (lambda sitting: sitting.press(Key.QUIT), 0),
        (lambda sitting: post("QUIT")(), 0),
        (lambda sitting: signal.raise_signal(signal.SIGINT), 130),
    ],
    ids=["escape", "window closed", "Ctrl-C"],
)
def test_playing_saves_a_replay_however_it_ends(
    deed: Callable[[Any], object],
    status: int,
    quick: None,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(Sitting, "tick", after(200, deed))
    path = tmp_path / "new folder" / "game.replay"
    arguments = ["play", "--level", "comb", "--seed", "3", "--lives", "5", "--save", str(path)]
    assert cli.main(arguments) == status
    assert f"arkanoid replay {shlex.quote(str(path))}" in capsys.readouterr().out
    replay = Replay.load(path)
    assert play_replay(replay).decisions >= 200
    assert (replay.config.lives, replay.config.frame_skip) == (5, 1)
    assert next(replay_states(replay)).worlds["round_number"][0] == 6


def test_an_exception_does_not_lose_the_game(
    quick: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def fail(sitting: Any) -> None:
        raise RuntimeError("broken")

    monkeypatch.setattr(Sitting, "tick", after(50, fail))
    path = tmp_path / "game.replay"
    with pytest.raises(RuntimeError, match="broken"):
        cli.main(["play", "--save", str(path)])
    assert play_replay(path).decisions == 50


def test_without_a_name_replays_are_dated_files_in_the_users_folder(
    quick: None,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    import platformdirs

    monkeypatch.setattr(platformdirs, "user_data_dir", lambda *_: str(tmp_path))
    monkeypatch.setattr(Sitting, "tick", after(30, lambda sitting: sitting.press(Key.QUIT)))
    for _ in range(2):
        assert cli.main(["play", "--lite"]) == 0
    printed = capsys.readouterr().out.splitlines()
    paths = [Path(line.rsplit(" ", 1)[1]) for line in printed]
    assert sorted(paths) == sorted((tmp_path / "replays").iterdir())
    assert len(set(paths)) == 2
    one, other = (Replay.load(path) for path in paths)
    assert not one.config.capsules
    assert not one.config.enemies
    assert one.start.random != other.start.random


def test_no_file_is_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "a.b.replay"
    for expected in ("a.b.replay", "a.b-2.replay", "a.b-3.replay"):
        free = free_path(path)
        assert free.name == expected
        free.write_text("")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--level", "spirol"], "Did you mean 'spiral'"),
        (["--level", "seed:x"], "as in seed:7"),
        (["--level", "warden", "--lite"], "has the boss"),
        (["--lives", "0"], "lives must be between 1 and 1000"),
        (["--speed", "nan"], "speed must be between"),
        (["--difficulty", "7"], "difficulty must be between 0 and 1"),
        (["--seed", "-1"], "seed must be between 0"),
    ],
)
def test_mistakes_are_one_line_each(
    arguments: list[str], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["play", "--save", str(tmp_path / "x.replay"), *arguments]) == 2
    message = capsys.readouterr().err
    assert message.startswith("arkanoid: error: ")
    assert message.count("\n") == 1
    assert words in message


def test_a_folder_that_cannot_be_made_is_reported_before_the_game(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    assert cli.main(["play", "--save", str(tmp_path / "file" / "x.replay")]) == 2
    assert "choose another --save" in capsys.readouterr().err


@pytest.mark.parametrize("save", [False, True])
def test_without_a_folder_of_the_user_one_can_play(
    save: bool,
    quick: None,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """An error ended the command: in a container, the home may not be written."""
    import platformdirs

    (tmp_path / "file").write_text("")
    monkeypatch.setattr(platformdirs, "user_data_dir", lambda *_: str(tmp_path / "file" / "data"))
    monkeypatch.setattr(Sitting, "tick", after(30, lambda sitting: sitting.press(Key.QUIT)))
    path = tmp_path / "x.replay"
    assert cli.main(["play", *(["--save", str(path)] if save else [])]) == 0
    out, err = capsys.readouterr()
    assert err.count("\n") == 1
    assert "high scores are " in err
    assert ("replays" in err) != save
    assert path.exists() == save
    assert out.startswith("score 0, round 1")
    assert ("watch it" in out) == save


def test_a_game_that_cannot_be_saved_does_not_end_the_play(
    quick: None,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """A full disk ended it, in the middle of an afternoon."""

    def fail(replay: Replay, path: Path) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr(Replay, "save", fail)
    monkeypatch.setattr(Sitting, "tick", after(30, lambda sitting: sitting.press(Key.QUIT)))
    assert cli.main(["play", "--save", str(tmp_path / "x.replay")]) == 0
    out, err = capsys.readouterr()
    assert "could not be saved: No space left" in err
    assert out == "score 0, round 1\n"


def test_playing_needs_pygame_and_no_other_extra(tmp_path: Path) -> None:
    program = """
import sys
missing = sys.argv[1].split(",")
for name in missing:
    sys.modules[name] = None
from arkanoid.agents.cli import main
from arkanoid.envs.play import sitting
from arkanoid.envs.play.controls import Key
sitting.Sitting.tick = lambda self: self.press(Key.QUIT)
sys.exit(main(["play", "--save", sys.argv[2]]))
"""
    path = str(tmp_path / "x.replay")
    train = "torch,stable_baselines3,imageio,PIL,tqdm,rich,tensorboard"
    assert run_program(program, train, path, warnings="default").stdout == ""
    message = run_program(program, "pygame", path, warnings="default", status=1).stderr
    assert "pip install pygame-ce" in message
    assert "Traceback" not in message
