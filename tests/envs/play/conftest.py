"""A display that needs no screen, and a recorded game."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from arkanoid.envs.batch.replays import Replay
from arkanoid.envs.play import by_hand
from arkanoid.envs.play.controls import Key
from arkanoid.envs.play.sitting import Sitting
from helpers.sittings import FAST, HEIGHT, lose, play_on, sit_down, tap


@pytest.fixture(autouse=True)
def dummy_display(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    """Windows open on SDL's dummy display, and high scores go into a folder of the test's own."""
    import platformdirs
    import pygame

    monkeypatch.setattr(platformdirs, "user_data_dir", lambda *_: str(tmp_path))

    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")
    yield
    pygame.display.quit()


@pytest.fixture(scope="session")
def game() -> Replay:
    """A game in which the paddle follows the ball for a while, and then loses it."""
    kept: list[Replay] = []
    sitting = sit_down("comb", kept, lives=1)
    tap(sitting, Key.FIRE)
    play_on(sitting, 400)
    lose(sitting)
    (replay,) = kept
    return replay


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Games run without waiting, in small pictures."""
    monkeypatch.setattr(Sitting, "frames_per_second", FAST)
    monkeypatch.setattr(by_hand, "screen_height", lambda: HEIGHT)
