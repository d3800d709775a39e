"""Films of the game, written picture by picture, without a display."""

import contextlib
import itertools
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...envs.atomic import replace_atomically
from ..experiment.errors import SettingsError
from ..experiment.files import check_folder
from ..experiment.programs import command

Picture = NDArray[np.uint8]  # [height, width, 3]

# Pictures per second that make a smooth film; more only make the file larger.
RATES = {".gif": 20.0, ".mp4": 60.0}
_GIF_COLOURS = 256
_GIF_UNIT = 10  # milliseconds: a GIF counts hundredths of a second
_QUALITY = 8  # of 10
_UNFINISHED = "ffmpeg did not finish the film; is the disk full?"


def write_film(path: Path, pictures: Iterable[Picture], rate: float) -> None:
    """Write a film of pictures, uint8 [height, width, 3], ``rate`` of them per second.

    The path's suffix, one of `RATES`, says which kind. An ``.mp4`` needs an even height and width.

    Raises:
        SettingsError: the suffix is none of these, there is no picture, or an ``.mp4`` is asked for
            and imageio-ffmpeg is not installed.
        ModuleNotFoundError: Pillow is not installed.
        OSError: the file cannot be written; what was there before stays.
    """
    check_film(path)
    rest = iter(pictures)
    first = next(rest, None)
    if first is None:
        raise SettingsError(f"{path}: there is no picture to write")
    write = _write_gif if path.suffix.lower() == ".gif" else _write_mp4
    replace_atomically(
        path, lambda unfinished: write(unfinished, itertools.chain([first], rest), rate)
    )


def check_film(path: Path) -> None:
    """Raise `SettingsError` unless a film of this name can be written, as far as that shows now."""
    if path.suffix.lower() not in RATES:
        raise SettingsError(
            f"{path}: a film's name ends in {' or '.join(RATES)}; give it after the model, if any"
        )
    check_folder(path)


def _write_gif(path: Path, pictures: Iterator[Picture], rate: float) -> None:
    from PIL import Image

    first = next(pictures)
    palette = Image.new("P", (1, 1))
    palette.putpalette(_gif_palette(first).tobytes())

    def images() -> Iterator[Any]:
        for index, picture in enumerate(itertools.chain([first], pictures)):
            image = Image.fromarray(picture).quantize(palette=palette, dither=Image.Dither.NONE)
            # Times are rounded, not durations: so the errors do not add up.
            begin, end = (round(at * 1000 / _GIF_UNIT / rate) for at in (index, index + 1))
            image.info["duration"] = (end - begin) * _GIF_UNIT
            yield image

    rest = images()
    next(rest).save(path, save_all=True, append_images=rest, loop=0, optimize=False)


def _write_mp4(path: Path, pictures: Iterator[Picture], rate: float) -> None:
    try:
        from imageio_ffmpeg import count_frames_and_secs, write_frames
    except ModuleNotFoundError:
        raise SettingsError(
            f"to write .mp4, run `{command('pip', 'install imageio-ffmpeg')}`; .gif needs only the "
            f"extra `train`"
        ) from None
    first = next(pictures)
    height, width, _ = first.shape
    # ffmpeg would take the beginning of a relative path such as `a:b.mp4` for a protocol.
    file = str(path.absolute())
    writer = write_frames(
        file,
        (width, height),
        fps=rate,  # pyright: ignore[reportArgumentType] (guessed from the default, a whole number)
        quality=_QUALITY,
        macro_block_size=2,
        ffmpeg_log_level="quiet",
    )
    sent = 0
    with contextlib.closing(writer):
        writer.send(None)
        for picture in itertools.chain([first], pictures):
            try:
                writer.send(np.ascontiguousarray(picture))
            except OSError:
                raise OSError(_UNFINISHED) from None
            sent += 1
    # ffmpeg's exit status is hidden, and on a full disk it leaves an incomplete film.
    try:
        written, _ = count_frames_and_secs(file)
    except (OSError, RuntimeError):
        written = 0
    if written != sent:
        raise OSError(_UNFINISHED)


def _gif_palette(picture: Picture) -> NDArray[np.uint8]:
    """Return a film's colours, uint8 [n, 3]: the game's, and the picture's most frequent others.

    All pictures share them: with a palette for each, the film would flicker.
    """
    from ...envs.draw.palette import PALETTE

    found, counts = np.unique(picture.reshape(-1, 3), axis=0, return_counts=True)
    ranked = np.concatenate([np.rint(PALETTE).astype(np.uint8), found[np.argsort(-counts)]])
    _, places = np.unique(ranked, axis=0, return_index=True)
    return ranked[np.sort(places)[:_GIF_COLOURS]]
