"""How fast games are shown: a speed that two keys change."""

import math

from .controls import Key

# The most pictures per second; a faster show leaves some out.
MOST_PICTURES = 60
FASTEST = 1000.0  # and as much slower
STEP = 2.0  # a key's factor
NOTICE_SECONDS = 1.0  # how long a new speed is written over the picture


class Pace:
    """The speed of a show.

    Args:
        rate: how many states of the game there are per second of its time.
        speed: a factor on the speed at which it was played.

    Attributes:
        frames_per_second: how many pictures per second give this speed.
        stride: after so many states comes the next picture.
    """

    def __init__(self, rate: float, speed: float = 1.0) -> None:
        self._rate = rate
        self._notice = 0
        self._set(speed)

    def press(self, key: Key) -> bool:
        """Become faster or slower; return whether the key does either."""
        if key not in (Key.FASTER, Key.SLOWER):
            return False
        speed = self._speed * (STEP if key is Key.FASTER else 1 / STEP)
        self._set(min(FASTEST, max(1 / FASTEST, speed)))
        self._notice = math.ceil(NOTICE_SECONDS * self.frames_per_second)
        return True

    def text(self) -> str:
        """Return what to write over the next picture: the speed, if it was changed just now."""
        if not self._notice:
            return ""
        self._notice -= 1
        return f"SPEED {self._speed:g}"

    def _set(self, speed: float) -> None:
        self._speed = speed
        self.stride = max(1, math.ceil(self._rate * speed / MOST_PICTURES))
        self.frames_per_second = self._rate * speed / self.stride
