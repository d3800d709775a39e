"""A window that shows pictures at the right speed, with pygame-ce (the extra `play`)."""

import os
import time
import warnings
from typing import Any

import numpy as np
from gymnasium.error import DependencyNotInstalled
from numpy.typing import NDArray

from .display import init_display

# A new window takes at most this fraction of the screen's height; the rest is for its frame, menus
# and bars.
SCREEN_PART = 0.9
# If a picture is later than this (seconds), because the program was stopped or busy, the following
# ones do not catch up.
PATIENCE = 0.1


def import_pygame() -> Any:
    """Import pygame-ce without its greeting and warnings.

    Raises:
        DependencyNotInstalled: it is missing, or the older pygame is installed instead.
    """
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    try:
        with warnings.catch_warnings():
            # Some releases use a deprecated function of the standard library.
            warnings.simplefilter("ignore")
            import pygame
    except ImportError as error:
        raise DependencyNotInstalled(
            "a window needs pygame-ce, which is not installed; run `pip install pygame-ce`"
        ) from error
    if not hasattr(pygame, "Window"):
        raise DependencyNotInstalled(
            f"a window needs pygame-ce 2.5 or newer, not pygame {pygame.version.ver}; run "
            "`pip uninstall pygame` and then `pip install --force-reinstall pygame-ce`"
        )
    return pygame


class Window:
    """A window for pictures; it opens with the first picture and takes its size.

    The user may resize it (the pictures keep their proportions) and may close it: from then on
    `show` does nothing and returns False, and the program goes on.

    Args:
        title: the window's title.
        frames_per_second: the most pictures per second; `show` waits accordingly.

    Attributes:
        events: pygame's events since the picture before the latest, except those that close a
            window.

    Raises:
        DependencyNotInstalled: pygame-ce is missing.
        ValueError: frames_per_second is not positive.
        NoDisplayError: by `show`: there is no screen.
    """

    def __init__(self, title: str, frames_per_second: float) -> None:
        self._pygame = import_pygame()
        self._title = title
        self.set_rate(frames_per_second)
        self._next = 0.0
        self._window: Any = None
        self._closed = False
        self._full_screen = False
        # Where the picture lies in the window: left, top and factor of its size.
        self._picture_place = (0.0, 0.0, 1.0)
        self.events: list[Any] = []

    @property
    def closed(self) -> bool:
        """Whether the window was closed."""
        return self._closed

    def show(self, frame: NDArray[np.uint8]) -> bool:
        """Wait until it is time, and show a picture, uint8 [height, width, 3].

        Returns:
            Whether the window is still open.
        """
        if self._closed:
            return False
        if self._window is None:
            self._open(frame.shape[1], frame.shape[0])
        self._wait()
        self._draw(frame)
        if self._close_asked():
            self.close()
        return not self._closed

    def set_rate(self, frames_per_second: float) -> None:
        """Change the most pictures per second.

        Raises:
            ValueError: it is not positive.
        """
        if not frames_per_second > 0:
            raise ValueError(f"frames_per_second must be positive; got {frames_per_second!r}")
        self._period = 1.0 / frames_per_second

    def toggle_full_screen(self) -> None:
        """Fill the screen, or become a window again."""
        self._full_screen = not self._full_screen
        if self._full_screen:
            self._window.set_fullscreen(desktop=True)
        else:
            self._window.set_windowed()

    def to_picture(self, x: float, y: float) -> tuple[float, float]:
        """Return the pixel of the picture that a pixel of the window shows."""
        left, top, factor = self._picture_place
        return (x - left) / factor, (y - top) / factor

    def close(self) -> None:
        """Close the window; a second call does nothing."""
        self._closed = True
        if self._window is not None:
            self._window.destroy()
            self._window = None

    def _open(self, width: int, height: int) -> None:
        """Open the window; its size is the largest multiple of the picture that fits the screen."""
        pygame = self._pygame
        init_display(pygame)
        screen_width, screen_height = pygame.display.get_desktop_sizes()[0]
        factor = max(1, min(screen_width // width, int(SCREEN_PART * screen_height) // height))
        size = (width * factor, height * factor)
        self._window = pygame.Window(self._title, size, resizable=True)
        # Imported on demand: it draws, and the window may be another program's.
        from .things import draw_icon

        self._window.set_icon(_as_surface(pygame, draw_icon()))

    def _wait(self) -> None:
        """Wait until the next picture is due."""
        now = time.perf_counter()
        if now > self._next + PATIENCE:
            self._next = now
        time.sleep(max(0.0, self._next - now))
        self._next += self._period

    def _draw(self, frame: NDArray[np.uint8]) -> None:
        """Draw a picture centred, as large as fits."""
        pygame = self._pygame
        surface = self._window.get_surface()
        height, width = frame.shape[:2]
        factor = min(surface.get_width() / width, surface.get_height() / height)
        size = (max(1, round(width * factor)), max(1, round(height * factor)))
        left = (surface.get_width() - size[0]) // 2
        top = (surface.get_height() - size[1]) // 2
        self._picture_place = (left, top, factor)
        picture = _as_surface(pygame, frame)
        if size != (width, height):
            whole = factor == int(factor)
            scale = pygame.transform.scale if whole else pygame.transform.smoothscale
            picture = scale(picture, size)
        surface.fill(0)
        surface.blit(picture, (left, top))
        self._window.flip()

    def _close_asked(self) -> bool:
        """Take the events; return whether the user closes this window."""
        pygame = self._pygame
        closing = (pygame.WINDOWCLOSE, pygame.QUIT)
        asked = False
        for event in pygame.event.get(closing):
            if event.type == pygame.QUIT or event.window == self._window:
                asked = True
            elif event.window is not None:
                pygame.event.post(event)  # for another window of this program
        # Take all others, too, for the queue must not become full.
        self.events = pygame.event.get(exclude=closing)
        return asked


def _as_surface(pygame: Any, picture: NDArray[np.uint8]) -> Any:
    """Return a picture, uint8 [height, width, 3], as pygame has them."""
    height, width = picture.shape[:2]
    return pygame.image.frombuffer(np.ascontiguousarray(picture), (width, height), "RGB")
