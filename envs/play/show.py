"""A show in a window: pictures at the right speed, keys and the mouse. All that knows pygame."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ..draw.view import FULL_HEIGHT, FULL_WIDTH, make_view
from .controls import KEYS, Key
from .window import SCREEN_PART, Window, import_pygame

LEFT_BUTTON = 1
# Pictures are a whole multiple of this high, so that each brick is as high as any other.
HEIGHT_STEP = int(2 * FULL_HEIGHT)
MAX_HEIGHT = 1440  # larger pictures take longer to scale than to draw; the window enlarges these


class Show(Protocol):
    """What is shown, and reacts to keys and the mouse.

    Attributes:
        ended: whether the show is over.
    """

    ended: bool

    def press(self, key: Key) -> None:
        """Take notice of a key that goes down."""

    def release(self, key: Key) -> None:
        """Take notice of a key that goes up."""

    def point(self, x: float) -> None:
        """Take notice of where the mouse points: x in the field, in brick widths."""

    def leave(self) -> None:
        """Take notice of that another window has the keys now."""

    def tick(self) -> None:
        """Go on by one picture."""

    def picture(self) -> NDArray[np.uint8]:
        """Return what is to be seen now, uint8 [height, width, 3]."""
        ...


def screen_height() -> int:
    """Return the height of pictures that fill the screen, in pixels, but for bars and menus.

    Raises:
        DependencyNotInstalled: pygame-ce is missing.
    """
    pygame = import_pygame()
    pygame.display.init()
    width, height = pygame.display.get_desktop_sizes()[0]
    fitting = min(SCREEN_PART * height, width / FULL_WIDTH * FULL_HEIGHT, MAX_HEIGHT)
    return max(1, int(fitting) // HEIGHT_STEP) * HEIGHT_STEP


def run_show(show: Show, title: str, frames_per_second: float) -> bool:
    """Run a show until it ends or its window is closed; return whether it was interrupted.

    Ctrl-C, and being told to terminate, end it between two pictures, so that nothing is lost.

    Raises:
        DependencyNotInstalled: pygame-ce is missing.
    """
    window = Window(title, frames_per_second)
    with _interruption() as interrupted:
        try:
            while not show.ended and not interrupted.is_set():
                picture = show.picture()
                if not window.show(picture):
                    break
                for event in window.events:
                    _react(show, window, picture, event)
                show.tick()
        finally:
            window.close()
    return interrupted.is_set()


def _react(show: Show, window: Window, picture: NDArray[np.uint8], event: Any) -> None:
    """Tell the show what an event of pygame means, or the window what concerns it alone."""
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
        show.leave()


def _to_field(window: Window, picture: NDArray[np.uint8], position: tuple[int, int]) -> float:
    """Return the x of the field, in brick widths, that is seen at a pixel of the window."""
    x, _ = window.to_picture(*position)
    view = make_view(picture.shape[0], picture.shape[1])[0]
    return float((x - view.left) / view.scale)


@contextmanager
def _interruption() -> Iterator[threading.Event]:
    """Let Ctrl-C and SIGTERM set an event instead of raising an exception anywhere.

    Other threads than the main one leave signals as they are.
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
