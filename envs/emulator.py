"""What wrappers for Atari's games ask of the emulator: `env.unwrapped.ale`."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .config import MAX_SIZE
from .interface import check_was_reset

if TYPE_CHECKING:
    from .batch.batch import Batch


class Emulator:
    """The part of the Arcade Learning Environment's interface that wrappers use, and its names.

    Gymnasium's `AtariPreprocessing` and stable-baselines3's `AtariWrapper` work with it. Before the
    first reset there is no picture (`gymnasium.error.ResetNeeded`).
    """

    def __init__(self, batch: "Batch") -> None:
        self._batch = batch

    def lives(self) -> int:
        """Return how many balls are left, the present one included."""
        return int(self._batch.worlds["lives"][0])

    def game_over(self) -> bool:
        """Return whether the last life is lost."""
        return self.lives() == 0

    def getScreenRGB(  # noqa: N802 (the emulator's name)
        self, buffer: NDArray[np.uint8] | None = None
    ) -> NDArray[np.uint8]:
        """Return the picture, uint8 [height, width, 3], in the buffer if there is one.

        Raises:
            TypeError, ValueError: the buffer is no such array.
        """
        return self._screen(buffer, 3)

    def getScreenGrayscale(  # noqa: N802 (the emulator's name)
        self, buffer: NDArray[np.uint8] | None = None
    ) -> NDArray[np.uint8]:
        """Return the picture's brightness, uint8 [height, width], in the buffer if there is one.

        The buffer may have a third axis, of length 1.

        Raises:
            TypeError, ValueError: the buffer is no such array.
        """
        return self._screen(buffer, 1)

    def _screen(self, buffer: Any, channels: int) -> NDArray[np.uint8]:
        # Imported on demand: playing without pictures needs none of the drawing kernels.
        from .draw.picture import draw_world

        batch = self._batch
        check_was_reset(batch.worlds, "picture")
        if buffer is not None:
            _check_buffer(buffer, channels)
        height, width = batch.config.picture_size if buffer is None else buffer.shape[:2]
        picture = draw_world(batch.worlds, batch.rules, 0, height, width, channels)
        picture = picture[:, :, 0] if channels == 1 else picture
        if buffer is None:
            return picture
        buffer[...] = picture.reshape(buffer.shape)
        filled: NDArray[np.uint8] = buffer
        return filled


def _check_buffer(buffer: Any, channels: int) -> None:
    """Raise an error unless a picture can be written into a buffer."""
    wanted = "[height, width]" if channels == 1 else f"[height, width, {channels}]"
    message = f"the buffer must be a writable array of uint8, {wanted}, at most {MAX_SIZE} each way"
    if not isinstance(buffer, np.ndarray) or buffer.dtype != np.uint8:
        raise TypeError(f"{message}; got {getattr(buffer, 'dtype', buffer)!r:.60}")
    fits = buffer.ndim in (2, 3) and all(1 <= pixels <= MAX_SIZE for pixels in buffer.shape[:2])
    if not fits or math.prod(buffer.shape[2:]) != channels or not buffer.flags.writeable:
        kind = "" if buffer.flags.writeable else " and read-only"
        raise ValueError(f"{message}; got one of shape {buffer.shape}{kind}")
