"""A show in a window: events, signals, the size of pictures."""

import signal
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from arkanoid.envs.play import show
from arkanoid.envs.play.controls import Key
from arkanoid.envs.play.show import HEIGHT_STEP, run_show, screen_height
from helpers.sittings import FAST, post


class Stage:
    """A show that notes what it is told, and does one deed per tick."""

    frames_per_second = FAST

    def __init__(self, *deeds: Callable[[], object]) -> None:
        self.ended = False
        self.told: list[Any] = []
        self._deeds = list(deeds)

    def press(self, key: Key) -> None:
        self.told.append(("press", key))

    def release(self, key: Key) -> None:
        self.told.append(("release", key))

    def point(self, x: float) -> None:
        self.told.append(("point", x))

    def lose_focus(self) -> None:
        self.told.append("lose focus")

    def tick(self) -> None:
        if self._deeds:
            self._deeds.pop(0)()
        else:
            self.ended = True

    def picture(self) -> np.ndarray:
        return np.zeros((512, 384, 3), np.uint8)


def test_events_become_keys_and_loss_of_focus() -> None:
    import pygame

    stage = Stage(
        post("KEYDOWN", key=pygame.K_a),
        post("KEYUP", key=pygame.K_a),
        post("KEYDOWN", key=pygame.K_q),
        post("MOUSEBUTTONDOWN", button=1),
        post("MOUSEBUTTONUP", button=1),
        post("MOUSEBUTTONDOWN", button=3),
        post("WINDOWFOCUSLOST"),
        post("KEYDOWN", key=pygame.K_ESCAPE),
        lambda: None,
    )
    assert not run_show(stage, "test")
    assert stage.told == [
        ("press", Key.LEFT),
        ("release", Key.LEFT),
        ("press", Key.FIRE),
        ("release", Key.FIRE),
        "lose focus",
        ("press", Key.QUIT),
    ]


@pytest.mark.parametrize("size", [(384, 512), (768, 1024), (1000, 512), (300, 900)])
def test_the_mouse_points_at_the_field_in_a_window_of_any_size(
    size: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    windows: list[Any] = []

    class Kept(show.Window):
        def __init__(self, *arguments: Any) -> None:
            super().__init__(*arguments)
            windows.append(self)

    monkeypatch.setattr(show, "Window", Kept)
    # Where the inner edges of the walls and the middle lie, from the window's proportions alone.
    factor = min(size[0] / 384, size[1] / 512)
    left = (size[0] - 384 * factor) / 2
    places = [left + factor * 384 * part for part in (0.5 / 12, 0.5, 11.5 / 12)]
    stage = Stage(
        lambda: setattr(windows[0]._window, "size", size),
        *(post("MOUSEMOTION", pos=(place, 10)) for place in places),
        lambda: None,
    )
    run_show(stage, "test")
    found = [x for told, x in stage.told if told == "point"]
    assert found == pytest.approx([0.0, 5.5, 11.0], abs=1.5 / factor / 32)


def test_f_fills_the_screen_and_is_not_passed_on(monkeypatch: pytest.MonkeyPatch) -> None:
    import pygame

    toggled: list[bool] = []
    monkeypatch.setattr(show.Window, "toggle_full_screen", lambda self: toggled.append(True))
    stage = Stage(post("KEYDOWN", key=pygame.K_f), post("KEYUP", key=pygame.K_f), lambda: None)
    run_show(stage, "test")
    assert toggled == [True]
    assert ("press", Key.FULL_SCREEN) not in stage.told


def test_a_window_fills_the_screen_and_becomes_a_window_again() -> None:
    window = show.Window("test", FAST)
    picture = np.full((64, 48, 3), 200, np.uint8)
    window.show(picture)
    for _ in range(4):
        window.toggle_full_screen()
        assert window.show(picture)
    window.close()


def test_closing_the_window_ends_the_show() -> None:
    stage = Stage(post("QUIT"), lambda: pytest.fail("the show goes on"))
    assert not run_show(stage, "test")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_the_show_between_two_pictures(number: signal.Signals) -> None:
    before = signal.getsignal(number)
    stage = Stage(
        lambda: signal.raise_signal(number), lambda: None, lambda: None, lambda: None, lambda: None
    )
    assert run_show(stage, "test")
    assert signal.getsignal(number) is before


def test_after_an_exception_the_window_is_closed_and_signals_are_as_before() -> None:
    before = signal.getsignal(signal.SIGINT)

    def fail() -> None:
        raise RuntimeError("the show is broken")

    with pytest.raises(RuntimeError, match="broken"):
        run_show(Stage(fail), "test")
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize(
    ("screen", "height"),
    [
        ((1920, 1080), 960),
        ((1366, 768), 672),
        ((2560, 1440), 1280),
        ((7680, 4320), 1440),
        ((500, 2000), 640),
        ((10, 10), HEIGHT_STEP),
    ],
)
def test_pictures_are_as_high_as_the_screen_allows(
    screen: tuple[int, int], height: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    import pygame

    monkeypatch.setattr(pygame.display, "get_desktop_sizes", lambda: [screen])
    assert screen_height() == height
