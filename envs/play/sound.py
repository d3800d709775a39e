"""Sound: a few tones, made from their formulas and played with pygame-ce."""

from collections.abc import Iterable
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .window import import_pygame

RATE = 22_050  # samples per second
LOUDEST = 0.25  # of what a sample can hold
ATTACK = 0.003  # seconds; without it a tone begins with a click
# pygame's buffer, in samples: a tone is heard 12 ms after it is due.
_BUFFER = 256


class Tone(Enum):
    """What is heard: the pitch at its beginning and its end, in Hz, and its length, in seconds."""

    WALL = (330.0, 330.0, 0.05)
    PADDLE = (440.0, 440.0, 0.08)
    BRICK = (660.0, 660.0, 0.09)
    ENEMY = (520.0, 180.0, 0.2)
    CAPSULE = (500.0, 1000.0, 0.2)
    LIFE_WON = (700.0, 1400.0, 0.4)
    LIFE_LOST = (300.0, 70.0, 0.6)
    CLEARED = (400.0, 1600.0, 0.7)


def samples(tone: Tone) -> NDArray[np.int16]:
    """Return a tone's samples, int16 [n]: a gliding sine with an octave in it, which fades."""
    begin, end, seconds = tone.value
    time = np.arange(round(seconds * RATE)) / RATE
    part = time / seconds
    phase = 2 * np.pi * (begin * time + (end - begin) * part * time / 2)
    wave = (np.sin(phase) + 0.3 * np.sin(2 * phase)) / 1.3
    volume = np.minimum(1.0, time / ATTACK) * (1.0 - part) ** 2
    return np.rint(32_767 * LOUDEST * volume * wave).astype(np.int16)


class Speaker:
    """Plays tones. It is off at first, and opens the sound device when it is switched on."""

    def __init__(self) -> None:
        self._sounds: dict[Tone, Any] = {}

    def switch(self) -> str:
        """Switch sound on or off; return what to tell the player."""
        if self._sounds:
            self.close()
            return "SOUND OFF"
        mixer = import_pygame().mixer
        # A machine may have no sound device, and a build of pygame no mixer.
        try:
            mixer.init(RATE, -16, 1, _BUFFER, allowedchanges=0)
            self._sounds = {tone: mixer.Sound(buffer=samples(tone)) for tone in Tone}
        except (ImportError, NotImplementedError, import_pygame().error):
            return "NO SOUND DEVICE"
        return "SOUND ON"

    def play(self, tones: Iterable[Tone]) -> None:
        """Play tones at once, if sound is on."""
        for tone in tones if self._sounds else ():
            self._sounds[tone].play()

    def close(self) -> None:
        """Close the sound device; a second call does nothing."""
        if self._sounds:
            self._sounds = {}
            import_pygame().mixer.quit()
