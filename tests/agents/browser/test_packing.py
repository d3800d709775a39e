"""What the page holds arrives as it was: every byte, and every letter that HTML may change."""

import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arkanoid.agents.browser.packing import pack, split_planes
from helpers.browser import DESKTOP, visit

# What a browser sees of an element, all of its bytes.
HELD = "async (name) => { const held = await unpack(name); return Array.from(held); }"
RANDOM = np.random.default_rng(7).bytes(100_000)  # has all letters, many times


def unpack(text: str) -> bytes:
    """Return what is packed, by other means than the page."""
    bits = "".join(f"{ord(letter) & 127:07b}" for letter in text)
    packed = bytes(int(bits[at : at + 8], 2) for at in range(0, len(bits) - 7, 8))
    return zlib.decompress(packed)


@pytest.mark.parametrize("length", [0, 1, 2, 3, 4, 5, 6, 7, 8, 50_000])
def test_packing_keeps_each_byte(length: int) -> None:
    text = pack(RANDOM[:length])
    assert unpack(text) == RANDOM[:length]
    assert not set(text) & set("\0\r<")


@pytest.mark.parametrize(("width", "split"), [(1, b"abcdefg"), (2, b"acegbdf"), (4, b"aebfcgd")])
def test_planes(width: int, split: bytes) -> None:
    assert split_planes(b"abcdefg", width) == split


@pytest.mark.parametrize("width", [1, 4])
@pytest.mark.parametrize("ends", ["\n", "\r\n"])
def test_a_browser_unpacks_each_byte(
    browser: Any, file: Path, tmp_path: Path, width: int, ends: str
) -> None:
    """Also where the ends of lines were changed on the way."""
    content = RANDOM[:-1]  # not a whole number of numbers
    packed = pack(split_planes(content, width))
    element = f'<script type="text/plain" id="data-test" data-width="{width}">{packed}</script>'
    text = file.read_text(encoding="utf-8").replace("<template", f"{element}<template")
    path = tmp_path / "page.html"
    path.write_text(text, encoding="utf-8", newline=ends)
    with visit(browser, path.as_uri(), **DESKTOP) as page:
        assert bytes(page.evaluate(HELD, "test")) == content


def test_modules_have_names_of_their_own(page: Any) -> None:
    """What goes wrong is told by the name of its file."""
    stack = page.evaluate(
        """async () => {
          const { jsonOf } = await import("arkanoid/data");
          return jsonOf("nothing").catch((error) => error.stack);
        }"""
    )
    assert "arkanoid/data.js:" in stack


def test_images_are_those_of_the_manifest(page: Any) -> None:
    """They are packed apart from it, one after the other."""
    from arkanoid.agents.browser.page import _GAMES
    from arkanoid.envs.browser.manifest import browser_games, make_manifest

    games = browser_games()
    manifest = make_manifest({name: games[name] for name in _GAMES})
    for name, game in manifest["games"].items():
        letters = f"btoa(String.fromCharCode(...arkanoid.arkanoid.manifest.games['{name}'].image))"
        assert page.evaluate(letters) == game["image"]
