"""The screen that some commands need; this module is not a command."""

import os
import sys

from ...envs.play.display import INVISIBLE, NoDisplayError, check_variables, init_display
from ...envs.play.window import import_pygame
from ..experiment.errors import SettingsError


def require_screen(instead: str) -> None:
    """Raise `SettingsError` unless a window can be shown, before anything slow is loaded.

    ``instead`` says what works without a screen.
    """
    try:
        # The variables alone tell it without pygame, which may be missing.
        check_variables(os.environ)
        pygame = import_pygame()
        init_display(pygame)
    except NoDisplayError as error:
        raise SettingsError(f"{error.fact}; {instead}") from None
    # Whoever set the variable need not be who now waits for a window.
    if pygame.display.get_driver() in INVISIBLE and sys.stderr.isatty():
        asked = os.environ.get("SDL_VIDEODRIVER")
        print(f"arkanoid: warning: SDL_VIDEODRIVER={asked} shows no window", file=sys.stderr)
