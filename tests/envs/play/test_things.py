"""The pictures of the game's things, the help card and the icon."""

import runpy

import imageio.v3 as iio
import numpy as np
import pytest
from arkanoid.envs.config import Config
from arkanoid.envs.draw.palette import BRICK_BODY, CAPSULE_BODY, PALETTE
from arkanoid.envs.play.card import Card
from arkanoid.envs.play.things import (
    BOSS_THING,
    BRICK_THINGS,
    CAPSULE_THINGS,
    ENEMY_THINGS,
    SHARD_THING,
    draw_icon,
    draw_things,
)
from arkanoid.envs.play.window import Window
from helpers.repository import DOCS
from helpers.sittings import FAST

THINGS = (*CAPSULE_THINGS, *BRICK_THINGS, *ENEMY_THINGS, BOSS_THING, SHARD_THING)


def test_each_thing_is_shown_whole_and_looks_like_no_other() -> None:
    pictures, masks = draw_things(THINGS, 24)
    for thing, picture, mask in zip(THINGS, pictures, masks, strict=True):
        assert picture.shape == (round(thing.height * 24), round(thing.width * 24), 3)
        assert mask.any(), thing.name
        if thing not in BRICK_THINGS:  # bricks fill their cells
            border = np.concatenate([mask[0], mask[-1], mask[:, 0], mask[:, -1]])
            assert not border.any(), thing.name
    assert len({picture.tobytes() for picture in pictures}) == len(THINGS)


def test_names_belong_to_the_pictures() -> None:
    """The commonest of the palette's bodies is that of the thing's own kind."""
    for things, first in ((CAPSULE_THINGS, CAPSULE_BODY), (BRICK_THINGS, BRICK_BODY)):
        colours = PALETTE[first + 1 : first + 1 + len(things)]
        for kind, picture in enumerate(draw_things(things, 48)[0]):
            away = abs(picture.reshape(-1, 1, 3) - colours).sum(axis=2)
            assert (away < 12).sum(axis=0).argmax() == kind, things[kind].name


@pytest.mark.parametrize("height", [64, 512, 960])
def test_a_card_leaves_out_what_a_game_lacks(height: int) -> None:
    def drawn(config: Config) -> np.ndarray:
        picture = np.zeros((height, height * 3 // 4, 3), np.uint8)
        Card(config, ["H: BACK"], height).draw(picture)
        return picture

    full, lite = (drawn(Config(enemies=some, capsules=some)) for some in (True, False))
    assert full.any(axis=2).sum() > 1.5 * lite.any(axis=2).sum() > 0
    # Nothing is cut off at the lower edge.
    assert not full[-height // 40 :].any()


def test_windows_have_the_icon(monkeypatch: pytest.MonkeyPatch) -> None:
    import pygame

    icon = draw_icon()
    assert icon.shape[0] == icon.shape[1]
    assert icon.std() > 20
    icons = []

    class Noted(pygame.Window):
        def set_icon(self, surface: pygame.Surface) -> None:
            icons.append(pygame.surfarray.array3d(surface).transpose(1, 0, 2))
            super().set_icon(surface)

    monkeypatch.setattr(pygame, "Window", Noted)
    window = Window("test", FAST)
    window.show(np.zeros((60, 40, 3), np.uint8))
    window.close()
    np.testing.assert_array_equal(icons[0], icon)


def test_the_page_of_things_shows_what_the_game_draws() -> None:
    """If not: ``python docs/pictures/things.py``."""
    script = runpy.run_path(str(DOCS / "pictures" / "things.py"))
    page = (DOCS / "things.md").read_text(encoding="utf-8")
    things = script["THINGS"]
    pictures, _ = draw_things(tuple(things.values()), script["SCALE"])
    for (name, thing), picture in zip(things.items(), pictures, strict=True):
        np.testing.assert_array_equal(iio.imread(DOCS / "pictures/things" / f"{name}.png"), picture)
        assert f"(pictures/things/{name}.png)" in page
        word = thing.name.replace(" ", ", ")
        assert f"| {word} |" in page or f"![{word}]" in page
    np.testing.assert_array_equal(iio.imread(DOCS / "pictures/icon.png"), draw_icon())
