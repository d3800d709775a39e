"""What the page takes from the game for windows: tones, times, and what is what."""

from base64 import b64encode
from collections.abc import Sequence
from typing import Any

from ...envs.draw.png import png_bytes
from ...envs.play.controls import STEPS
from ...envs.play.sitting import OVER_TICKS, TITLE_TICKS, WARNING_TICKS
from ...envs.play.sound import ATTACK, LOUDEST, Tone
from ...envs.play.things import (
    BOSS_THING,
    BRICK_THINGS,
    CAPSULE_THINGS,
    ENEMY_THINGS,
    SHARD_THING,
    Thing,
    draw_icon,
    draw_things,
)
from ...envs.rules import BRICK_LETTERS

_SCALE = 24  # CSS pixels per brick width, in pictures of things
_DENSITY = 2  # pixels of a picture per CSS pixel
_METALS = 2  # of the kinds of bricks, the last ones
_THINGS = (
    *CAPSULE_THINGS,
    BRICK_THINGS[0]._replace(name="colours"),
    *BRICK_THINGS[-_METALS:],
    ENEMY_THINGS[0],
    SHARD_THING,
    BOSS_THING,
)


def page_facts() -> dict[str, Any]:
    """Return what the page's modules find in the element of this name, for `json.dumps`."""
    return {
        "steps": STEPS,
        "sitting": {"over": OVER_TICKS, "title": TITLE_TICKS, "warning": WARNING_TICKS},
        "hearing": {
            "loudness": LOUDEST,
            "attack": ATTACK,
            "tones": {tone.name: tone.value for tone in Tone},
        },
        "things": _describe(_THINGS),
        "bricks": [
            {"letter": letter, **described}
            for letter, described in zip(BRICK_LETTERS[1:], _describe(BRICK_THINGS), strict=True)
        ],
    }


def _describe(things: Sequence[Thing]) -> list[dict[str, Any]]:
    """Return the names, meanings and pictures of things."""
    pictures, _ = draw_things(things, _DENSITY * _SCALE)
    return [
        {
            "name": thing.name,
            "meaning": thing.meaning,
            "picture": _as_text(png_bytes(picture)),
            "width": picture.shape[1] / _DENSITY,
        }
        for thing, picture in zip(things, pictures, strict=True)
    ]


def page_icon() -> str:
    """Return the page's icon, a PNG file in base64."""
    return _as_text(png_bytes(draw_icon()))


def _as_text(content: bytes) -> str:
    return b64encode(content).decode()
