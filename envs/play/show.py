"""Runs a show in a window: pictures at the right speed, keys and the mouse."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..draw.view import FULL_HEIGHT, FULL_WIDTH, make_view
from .controls import KEYS, Key
from .display import init_display
from .window import SCREEN_PART, Window, import_pygame

LEFT_BUTTON = 1
# The height of pictures is a multiple of this, so that all bricks have the same height.
HEIGHT_STEP = int(2 * FULL_HEIGHT)
MAX_HEIGHT = 1440  # on larger screens the window enlarges the pictures, which is faster


class Show(Protocol):
    """Something that makes pictures and reacts to keys and the mouse.

    Attributes:
        ended: whether the show is over.
    """

    ended: bool

    @property
    def frames_per_second(self) -> float:
        """The most pictures per second."""
        ...

    def press(self, key: Key) -> None:
        """React to a key that is pressed."""

    def release(self, key: Key) -> None:
        """React to a key that is released."""

    def point(self, x: float) -> None:
        """React to the mouse: it points at x in the field, in brick widths."""

    def lose_focus(self) -> None:
        """React to another window that takes the keys."""

    def tick(self) -> None:
        """Go on by one picture."""

    def picture(self) -> NDArray[np.uint8]:
        """Return the present picture, uint8 [height, width, 3]."""
        ...


def screen_height() -> int:
    """Return the height in pixels of pictures that fill the screen, except bars and menus.

    Raises:
        DependencyNotInstalled: pygame-ce is missing.
        NoDisplayError: there is no screen.
    """
    pygame = import_pygame()
    init_display(pygame)
    width, height = pygame.display.get_desktop_sizes()[0]
    fitting = min(SCREEN_PART * height, width / FULL_WIDTH * FULL_HEIGHT, MAX_HEIGHT)
    return max(1, int(fitting) // HEIGHT_STEP) * HEIGHT_STEP


def run_show(show: Show, title: str) -> bool:
    """Run a show until it ends or its window is closed; return whether a signal ended it.

    Ctrl-C (SIGINT) and SIGTERM end it between two pictures, so that nothing is lost.

    Raises:
        DependencyNotInstalled: pygame-ce is missing.
    """
    window = Window(title, show.frames_per_second)
    with _catch_signals() as interrupted:
        try:
            while not show.ended and not interrupted.is_set():
                picture = show.picture()
                if not window.show(picture):
                    break
                for event in window.events:
                    _react(show, window, picture, event)
                show.tick()
                window.set_rate(show.frames_per_second)
        finally:
            window.close()
    return interrupted.is_set()


def _react(show: Show, window: Window, picture: NDArray[np.uint8], event: Any) -> None:
    """Pass an event of pygame on to the show, or to the window if only the window needs it."""
    pygame = import_pygame()
    if event.type in (pygame.KEYDOWN, pygame.KEYUP) and event.key in KEYS:
        key = KEYS[event.key]
        if event.type == pygame.KEYUP:
            show.release(key)
        elif key is Key.FULL_SCREEN:
            window.toggle_full_screen()
        else:
            show.press(key)
    elif event.type == pygame.MOUSEMOTION:
        show.point(_to_field(window, picture, event.pos))
    elif event.type == pygame.MOUSEBUTTONDOWN and event.button == LEFT_BUTTON:
        show.press(Key.FIRE)
    elif event.type == pygame.MOUSEBUTTONUP and event.button == LEFT_BUTTON:
        show.release(Key.FIRE)
    elif event.type == pygame.WINDOWFOCUSLOST:
        show.lose_focus()


def _to_field(window: Window, picture: NDArray[np.uint8], position: tuple[int, int]) -> float:
    """Return the x in the field, in brick widths, that a pixel of the window shows."""
    x, _ = window.to_picture(*position)
    view = make_view(picture.shape[0], picture.shape[1])[0]
    return float((x - view.left) / view.scale)


@contextmanager
def _catch_signals() -> Iterator[threading.Event]:
    """Let Ctrl-C and SIGTERM set an event instead of raising an exception.

    Only the main thread can do so; other threads leave signals alone.
    """
    event = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield event
        return
    signals = (signal.SIGINT, signal.SIGTERM)
    before = [signal.signal(number, lambda *_: event.set()) for number in signals]
    try:
        yield event
    finally:
        for number, handler in zip(signals, before, strict=True):
            signal.signal(number, handler)
