"""Whether there is a screen that can show a window."""

import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

# What SDL takes where it finds no screen: then a window opens that nobody sees.
INVISIBLE = ("dummy", "offscreen")
_ASKED = "SDL_VIDEODRIVER"  # SDL's own variable, which names the driver to take


# What works without a screen, for programs. Gymnasium's `check_env` opens a window, too.
_INSTEAD = (
    'render_mode="rgb_array" needs none, SDL_VIDEODRIVER=dummy gives a window that nobody sees, '
    "and check_env(env, skip_render_check=True) opens none"
)


class NoDisplayError(RuntimeError):
    """There is no screen for a window here.

    Args:
        reason: how one knows.

    Attributes:
        fact: the same as a sentence, without what works instead.
    """

    def __init__(self, reason: str) -> None:
        self.fact = f"there is no display here for a window ({reason})"
        super().__init__(f"{self.fact}; {_INSTEAD}")


def init_display(pygame: Any) -> None:
    """Initialise pygame's display.

    Raises:
        NoDisplayError: there is no screen. Who asks for an invisible one, as tests do by
            ``SDL_VIDEODRIVER=dummy``, gets it.
    """
    check_variables(os.environ)
    try:
        with _quiet():
            pygame.display.init()
    except pygame.error as error:
        raise NoDisplayError(str(error)) from None
    driver = pygame.display.get_driver()
    if driver in INVISIBLE and not os.environ.get(_ASKED):
        pygame.display.quit()
        raise NoDisplayError(f"SDL found none, and would draw {driver}")


def check_variables(variables: Mapping[str, str]) -> None:
    """Raise `NoDisplayError` if environment variables tell that there is no screen."""
    if not sys.platform.startswith("linux") or variables.get(_ASKED):
        return
    # Without a desktop SDL can also draw on the console, through a graphics card.
    if not (variables.get("DISPLAY") or variables.get("WAYLAND_DISPLAY") or _has_card()):
        raise NoDisplayError("neither DISPLAY nor WAYLAND_DISPLAY is set")


def _has_card() -> bool:
    return any(Path("/dev/dri").glob("card*"))


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep libraries in C from writing to standard error: they tell what SDL tries in vain."""
    try:
        kept = os.dup(2)
    except OSError:  # it is closed
        yield
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
