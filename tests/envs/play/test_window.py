"""The window, on SDL's dummy display."""

import sys

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.envs.play import window as window_module
from arkanoid.envs.play.window import Window
from gymnasium.error import DependencyNotInstalled
from helpers.processes import run_program
from helpers.sittings import FAST


def frame(height: int = 60, width: int = 40) -> np.ndarray:
    """Left half red, right half blue, the first row green."""
    image = np.zeros((height, width, 3), np.uint8)
    image[:, : width // 2, 0] = 255
    image[:, width // 2 :, 2] = 255
    image[0] = (0, 255, 0)
    return image


def shown(window: Window) -> np.ndarray:
    """The window's pixels, uint8 [height, width, 3]."""
    import pygame

    surface = window._window.get_surface()
    return pygame.surfarray.array3d(surface).transpose(1, 0, 2)


def test_it_opens_at_a_whole_multiple_and_shows_the_pixels_as_they_are() -> None:
    window = Window("test", FAST)
    image = frame()
    assert window.show(image)
    pixels = shown(window)
    factor = pixels.shape[0] // 60
    np.testing.assert_array_equal(pixels, image.repeat(factor, 0).repeat(factor, 1))
    window.close()


@pytest.mark.parametrize("size", [(400, 60), (40, 500), (33, 47), (1, 1)])
def test_resized_it_keeps_the_proportions(size: tuple[int, int]) -> None:
    window = Window("test", FAST)
    window.show(frame())
    window._window.size = size
    window.show(np.full((60, 40, 3), 255, np.uint8))
    rows, columns = np.nonzero(shown(window).any(axis=2))
    height, width = np.ptp(rows) + 1, np.ptp(columns) + 1
    factor = min(size[0] / 40, size[1] / 60)
    assert (height, width) == (max(1, round(60 * factor)), max(1, round(40 * factor)))
    # It is centred.
    assert abs(rows.min() - (size[1] - 1 - rows.max())) <= 1
    assert abs(columns.min() - (size[0] - 1 - columns.max())) <= 1
    window.close()


def test_pictures_of_another_size_are_shown_too() -> None:
    window = Window("test", FAST)
    window.show(frame())
    assert window.show(frame(90, 90))
    window.close()


@pytest.mark.parametrize("kind", ["WINDOWCLOSE", "QUIT"])
def test_closing_the_window_ends_the_show_and_not_the_program(kind: str) -> None:
    import pygame

    window = Window("test", FAST)
    window.show(frame())
    pygame.event.post(pygame.event.Event(getattr(pygame, kind), window=window._window))
    assert not window.show(frame())
    assert window.closed
    # A program that does not check goes on without a window, and does not wait.
    slow = Window("test", 1e-3)
    slow.close()
    for _ in range(3):
        assert not slow.show(frame())
    slow.close()


def test_a_window_does_not_take_the_events_of_another_one() -> None:
    import pygame

    one, other = Window("one", FAST), Window("other", FAST)
    one.show(frame())
    other.show(frame())
    pygame.event.post(pygame.event.Event(pygame.WINDOWCLOSE, window=other._window))
    assert one.show(frame())
    assert not other.show(frame())
    assert one.show(frame())
    one.close()


def test_the_event_queue_does_not_run_full() -> None:
    import pygame

    window = Window("test", FAST)
    window.show(frame())
    pygame.event.post(pygame.event.Event(pygame.MOUSEMOTION, pos=(1, 1), rel=(0, 0), buttons=()))
    window.show(frame())
    assert not pygame.event.peek(pygame.MOUSEMOTION)
    window.close()


class Clock:
    """Time that passes only where somebody sleeps; it takes the place of the module `time`."""

    now = 100.0

    def perf_counter(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds


def test_it_keeps_the_speed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures come no faster than asked for; those after a late one catch up."""
    clock = Clock()
    monkeypatch.setattr(window_module, "time", clock)
    window = Window("test", 50.0)
    window.show(frame())
    for picture in range(10):
        clock.sleep(0.03 if picture == 4 else 0.005)
        window.show(frame())
    assert clock.now == pytest.approx(100.0 + 10 / 50.0)
    window.close()


def test_after_a_pause_it_does_not_rush(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setattr(window_module, "time", clock)
    window = Window("test", 50.0)
    window.show(frame())
    clock.sleep(0.3)
    for _ in range(6):
        window.show(frame())
    # The first picture after the pause is due at once, the other five are not.
    assert clock.now == pytest.approx(100.3 + 5 / 50.0)
    window.close()


@pytest.mark.parametrize("frames_per_second", [0, -1.0, float("nan")])
def test_an_illegal_speed_is_refused(frames_per_second: float) -> None:
    with pytest.raises(ValueError, match="frames_per_second must be positive"):
        Window("test", frames_per_second)


def test_without_pygame_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pygame", None)
    with pytest.raises(DependencyNotInstalled, match="pip install pygame-ce"):
        Window("test", 60)


def test_the_older_pygame_is_distinguished_from_pygame_ce(monkeypatch: pytest.MonkeyPatch) -> None:
    import pygame

    monkeypatch.delattr(pygame, "Window")
    with pytest.raises(DependencyNotInstalled, match=r"pygame-ce 2\.5 or newer, not pygame"):
        Window("test", 60)


def test_pygame_is_imported_late_quietly_and_without_warnings() -> None:
    script = (
        "import sys, arkanoid.envs.play.window as module; assert 'pygame' not in sys.modules;"
        "module.Window('test', 60); assert 'pygame' in sys.modules"
    )
    done = run_program(script)
    assert (done.stdout, done.stderr) == ("", "")


def test_the_environment_plays_on_when_its_window_is_closed() -> None:
    import pygame

    env = gym.make("arkanoid:Arkanoid-v0", render_mode="human", frame_skip=1)
    env.reset(seed=1)
    env.step(0)
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    for _ in range(3):
        env.step(0)
    env.reset()
    env.close()
    env.close()


@pytest.mark.parametrize("frame_skip", [1, 4, 7, 90])
def test_a_window_of_the_environment_shows_sixty_ticks_a_second(
    frame_skip: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where the frames per second are no whole number, as `render_fps` must be."""
    due: list[float] = []
    monkeypatch.setattr(Window, "_wait", lambda window: due.append(window._period))
    env = gym.make("arkanoid:Arkanoid-v0", render_mode="human", frame_skip=frame_skip)
    env.reset(seed=1)
    env.step(0)
    env.close()
    assert due == [pytest.approx(frame_skip / 60.0)] * 2


def test_a_window_of_the_environment_fits_the_screen_with_whole_pixels_per_brick() -> None:
    import pygame

    env = gym.make("arkanoid:Arkanoid-v0", render_mode="human", frame_skip=1)
    env.reset(seed=1)
    width, height = env.unwrapped._window._window.size
    screen_width, screen_height = pygame.display.get_desktop_sizes()[0]
    assert screen_height / 2 < height <= 0.9 * screen_height
    assert width <= screen_width
    assert height % 16 == 0
    assert width * 16 == height * 12
    env.close()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="there is always a display")
def test_without_a_display_gymnasiums_check_says_what_to_do() -> None:
    """`check_env` also opens a window; its error named no way to go on."""
    program = (
        "import os, gymnasium as gym\n"
        "from gymnasium.utils.env_checker import check_env\n"
        "for name in ('DISPLAY', 'WAYLAND_DISPLAY', 'SDL_VIDEODRIVER'):\n"
        "    os.environ.pop(name, None)\n"
        "env = gym.make('arkanoid:ArkanoidLite-v0').unwrapped\n"
        "try:\n"
        "    check_env(env)\n"
        "except RuntimeError as error:\n"
        "    print(error)\n"
        "check_env(env, skip_render_check=True)\n"
    )
    told = run_program(program, warnings="default").stdout
    assert "no display" in told
    assert "skip_render_check=True" in told
