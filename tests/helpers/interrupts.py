"""Ctrl-C at a chosen moment."""

import sys


def interrupted_at(event, function):
    """Call a function; Ctrl-C comes with its n-th call of ours. Tell whether it came."""
    left = event

    def profile(frame, kind, argument):
        nonlocal left
        # Python looks for signals where a function begins.
        if kind == "call" and frame.f_globals.get("__name__", "").startswith("arkanoid."):
            left -= 1
            if left == 0:
                raise KeyboardInterrupt

    sys.setprofile(profile)
    try:
        function()
    except KeyboardInterrupt:
        return True
    finally:
        sys.setprofile(None)
    return False
