"""The command `arkanoid replay`: verification, films, and its error messages."""

import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import imageio.v3 as iio
import numpy as np
import pytest
from arkanoid.agents import cli
from arkanoid.envs.batch.playback import replay_frames, replay_states
from arkanoid.envs.batch.replays import Replay
from arkanoid.envs.draw.picture import draw_world
from arkanoid.envs.play.controls import Key
from arkanoid.envs.play.viewer import Viewer
from PIL import Image


def test_a_replay_is_verified(
    game: Replay, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "game.replay"
    game.save(path)
    assert cli.main(["replay", str(path), "--verify"]) == 0
    assert f"score {game.result.score}" in capsys.readouterr().out
    commands = game.commands.copy()
    commands[50:90, 0] = -commands[50:90, 0] + 0.5
    Replay(**(vars(game) | {"commands": commands.clip(-1.0, 1.0)})).save(path)
    for arguments in (["--verify"], ["--export", str(tmp_path / "x.png")]):
        assert cli.main(["replay", str(path), *arguments]) == 1
        assert f"error: {path}: the game " in capsys.readouterr().err


def test_the_last_picture_as_png(game: Replay, tmp_path: Path) -> None:
    game.save(tmp_path / "game.replay")
    export = ["replay", str(tmp_path / "game.replay"), "--export", str(tmp_path / "x.PNG")]
    assert cli.main(export) == 0
    *_, last = replay_frames(game)
    np.testing.assert_array_equal(iio.imread(tmp_path / "x.PNG"), last)
    assert cli.main([*export, "--to", "2", "--height", "64"]) == 0
    states = replay_states(game)
    for _ in range(121):
        batch = next(states)
    expected = draw_world(batch.worlds, batch.rules, 0, 64)
    np.testing.assert_array_equal(iio.imread(tmp_path / "x.PNG"), expected)


@pytest.mark.parametrize(("speed", "seconds"), [(1.0, 3.0), (3.0, 1.0), (0.5, 6.0)])
def test_a_film_as_gif(game: Replay, tmp_path: Path, speed: float, seconds: float) -> None:
    game.save(tmp_path / "game.replay")
    film = tmp_path / "x.gif"
    part = ["--from", "1", "--to", "4", "--height", "96", "--speed", str(speed)]
    assert cli.main(["replay", str(tmp_path / "game.replay"), "--export", str(film), *part]) == 0
    with Image.open(film) as clip:
        assert clip.size == (72, 96)
        lengths = []
        for index in range(clip.n_frames):
            clip.seek(index)
            lengths.append(clip.info["duration"])
            picture = np.asarray(clip.convert("RGB")).astype(float)
            if index == 0:
                first = picture
        # The last picture stays for a while.
        assert sum(lengths) / 1000 == pytest.approx(seconds, abs=0.11)
    shown = replay_states(game)
    for _ in range(61):
        batch = next(shown)
    expected = draw_world(batch.worlds, batch.rules, 0, 96)
    assert abs(first - expected).mean() < 2.0


def test_a_film_as_mp4(game: Replay, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a stand-in for ffmpeg, which is large and which nothing else needs."""
    calls: list[Any] = []
    frames: list[np.ndarray] = []

    def write_frames(path: str, size: tuple[int, int], **keywords: Any) -> Iterator[None]:
        # It has a name of its own until it is finished.
        calls.append((Path(path).name.endswith("-x.mp4"), size, keywords["fps"]))
        try:
            while True:
                frames.append((yield))
        finally:
            calls.append("closed")

    def count_frames(path: str) -> tuple[int, float]:
        return len(frames), len(frames) / 60

    stand_in = SimpleNamespace(write_frames=write_frames, count_frames_and_secs=count_frames)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", stand_in)
    game.save(tmp_path / "game.replay")
    film = tmp_path / "x.mp4"
    part = ["--to", "1", "--height", "101"]
    assert cli.main(["replay", str(tmp_path / "game.replay"), "--export", str(film), *part]) == 0
    assert film.exists()
    assert calls == [(True, (76, 102), 60.0), "closed"]
    assert len(frames) == 61
    assert all(frame.shape == (102, 76, 3) for frame in frames)


def test_films_name_the_package_that_is_missing(
    game: Replay,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    game.save(tmp_path / "game.replay")
    replay = ["replay", str(tmp_path / "game.replay"), "--export"]
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    assert cli.main([*replay, str(tmp_path / "x.mp4")]) == 2
    assert "pip install imageio-ffmpeg" in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "PIL", None)
    assert cli.main([*replay, str(tmp_path / "x.gif")]) == 1
    assert 'pip install -e ".[train]"' in capsys.readouterr().err
    assert cli.main([*replay, str(tmp_path / "x.png")]) == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["no.replay"], "no.replay: No such file"),
        (["GAME", "--export", "x.avi"], "exports are .gif, .mp4 or .png"),
        (["GAME", "--export", "no/such/x.gif"], "no/such: there is no such folder"),
        (["GAME", "--export", "x.png", "--from", "999"], "the game lasts"),
        (["GAME", "--export", "x.png", "--from", "1e308"], "the game lasts"),
        (
            ["GAME", "--export", "x.png", "--height", "0"],
            "must be an integer, at least 2",
        ),
        (["GAME", "--export", "x.png", "--height", "1e6"], "height must be between"),
        (["WRONG"], "this is no replay"),
    ],
)
def test_mistakes_are_one_line_each(
    game: Replay,
    arguments: list[str],
    words: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    game.save("GAME")
    Path("WRONG").write_text("name: Mine\n", encoding="utf-8")
    assert cli.main(["replay", *arguments]) == 2
    message = capsys.readouterr().err
    assert message.startswith("arkanoid: error: ")
    assert message.count("\n") == 1
    assert words in message


def test_a_part_may_end_long_after_the_game(game: Replay, tmp_path: Path) -> None:
    """Enormous numbers of seconds were an OverflowError."""
    game.save(tmp_path / "game.replay")
    export = ["replay", str(tmp_path / "game.replay"), "--export"]
    for name, part in {"all.png": [], "long.png": ["--to", "1e308"]}.items():
        assert cli.main([*export, str(tmp_path / name), *part]) == 0
    assert (tmp_path / "all.png").read_bytes() == (tmp_path / "long.png").read_bytes()


@pytest.mark.parametrize("speed", ["0.001", "1000"])
def test_a_film_has_the_slowest_and_the_fastest_speed(
    speed: str, game: Replay, tmp_path: Path
) -> None:
    game.save(tmp_path / "game.replay")
    for name in ("x.gif", "x.mp4"):
        export = ["replay", str(tmp_path / "game.replay"), "--export", str(tmp_path / name)]
        assert cli.main([*export, "--to", "0.1", "--height", "64", "--speed", speed]) == 0


@pytest.mark.parametrize(
    "option",
    [
        *(["--speed", speed] for speed in ("0", "nan", "1e308", "1e-300")),
        ["--from", "-1"],
    ],
)
def test_illegal_numbers_are_refused(option: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["replay", "x", *option]) == 2
    assert f"argument {option[0]}: must be a number" in capsys.readouterr().err


def test_a_replay_is_shown_in_a_window(
    game: Replay, quick: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    game.save(tmp_path / "game.replay")
    original = Viewer.tick
    ticks = []

    def tick(self: Any) -> None:
        original(self)
        ticks.append(1)
        if self.text()[0] == "THE END":
            self.press(Key.QUIT)

    monkeypatch.setattr(Viewer, "tick", tick)
    assert cli.main(["replay", str(tmp_path / "game.replay"), "--speed", "200"]) == 0
    assert len(ticks) == pytest.approx(game.result.decisions / 200, abs=2)
