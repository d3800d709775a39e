"""Level files: what is read, and what is refused with its line; the named levels."""

import re
import runpy
from pathlib import Path

import imageio.v3 as iio
import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv
from arkanoid.envs.levels import (
    CAMPAIGN,
    level_names,
    load_level,
    parse_level,
)
from arkanoid.envs.levels.clearability import search_reachable, unreachable_bricks
from arkanoid.envs.rules import GOLD, LATTICE_TOP, SILVER
from numpy.typing import NDArray
from scipy import ndimage

ROOT = Path(__file__).resolve().parents[3]
GOOD = "name: Tiny\ncomment: two bricks\n\n.w.......X.\n"
CAGE = "name: Cage\n\n..XXX......\n..XwX......\n..XXX......\n"


def out_of_reach(kinds: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """The breakable bricks out of a ball's reach in levels [n, 18, 11], by SciPy's labelling."""
    free = np.pad(kinds != GOLD, ((0, 0), (1, 1), (0, 0)), constant_values=True)
    side_by_side = np.zeros((3, 3, 3), np.bool_)
    side_by_side[1] = [[0, 1, 0], [1, 1, 1], [0, 1, 0]]
    labels, _ = ndimage.label(free, side_by_side)
    reached = labels == labels[:, -1:, :1]
    breakable: NDArray[np.bool_] = (kinds != 0) & (kinds != GOLD)
    return breakable & ~reached[:, 1:-1]


def metallic_levels(count: int) -> NDArray[np.uint8]:
    """Random levels with much gold, so that most have bricks out of reach; uint8 [n, 18, 11]."""
    rng = np.random.default_rng(5)
    gold = rng.uniform(size=(count, 18, 11)) < rng.uniform(0.2, 0.6, (count, 1, 1))
    return np.where(gold, GOLD, rng.integers(0, GOLD, (count, 18, 11))).astype(np.uint8)


def test_a_level_is_read_row_by_row_from_the_top():
    tiny = parse_level(GOOD, "tiny.txt")
    assert (tiny.name, tiny.comment, tiny.boss) == ("Tiny", "two bricks", False)
    assert tiny.kinds.shape == (18, 11)
    assert np.argwhere(tiny.kinds).tolist() == [[0, 1], [0, 9]]
    assert (tiny.kinds[0, 1], tiny.kinds[0, 9]) == (1, 10)


@pytest.mark.parametrize(
    "text",
    [
        ".w.......X.",
        "\n\n.w.......X.\n\n \n",
        "name: Tiny\r\n\r\n.w.......X.\r\n",
        "comment: a colon: is no heading\n.w.......X.  ",
    ],
)
def test_headings_blank_lines_and_line_ends_are_free(text):
    level = parse_level(text, "some/tiny.txt")
    assert np.argwhere(level.kinds).tolist() == [[0, 1], [0, 9]]
    assert level.name in ("tiny", "Tiny")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name: A\n\n.w.\n", "a.txt, line 3: 3 characters; a row of bricks has 11"),
        (
            "name: A\n\n.w.......?.\n",
            "a.txt, line 3, column 10: '?' is no brick; known are '.wocgrb",
        ),
        ("author: me\n", "a.txt, line 1: unknown heading 'author'; known: name, comment, boss"),
        ("boss: maybe\n\n.w.........", "a.txt, line 1: boss must be 'yes' or 'no'; got 'maybe'"),
        ("wwwwwwwwwww\n\nwwwwwwwwwww", "a.txt, line 2: 0 characters; a row of bricks has 11"),
        ("name: A\n\n" + "wwwwwwwwwww\n" * 19, "a.txt: 19 rows of bricks; at most 18"),
        ("name: A\n\nX..........\n", "a.txt: there is no breakable brick"),
        ("", "a.txt: there is no breakable brick"),
        (CAGE, "the level can't be cleared: line 4 column 4. Leave a gap of one cell at a side"),
        (
            "...........\nXXXXXXXXXXX\nw.S........\n.S..w....y.\nXXXXXXXXXXX\n",
            "line 3 columns 1, 3; line 4 columns 2, 5, 10.",
        ),
    ],
)
def test_malformed_levels_are_refused(text, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        parse_level(text, "a.txt")


def test_a_ball_passes_a_gap_at_a_side_but_not_at_a_corner():
    below = CAGE.rsplit("XXX", 1)
    assert parse_level("X.X".join(below), "cage.txt").kinds[1, 3] == 1
    with pytest.raises(ValueError, match="line 4 column 4"):
        parse_level(".XX".join(below), "cage.txt")
    # From above the bricks a ball comes to any column.
    above = "wX.........\noX.........\nX.........."
    assert parse_level(above, "above.txt").kinds[:2, 0].tolist() == [1, 2]
    with pytest.raises(ValueError, match="line 2 column 1"):
        parse_level(above.replace("w", "X"), "above.txt")


def test_a_level_file_of_ones_own(tmp_path):
    file = tmp_path / "mine.txt"
    file.write_text(GOOD)
    assert load_level(str(file)).name == "Tiny"
    file.write_text(CAGE)
    with pytest.raises(ValueError, match=re.escape(f"{file}: gold (X) keeps the ball")):
        load_level(str(file))


def test_a_level_file_may_begin_with_a_byte_order_mark(tmp_path):
    file = tmp_path / "marked.txt"
    file.write_text(GOOD, encoding="utf-8-sig")
    assert load_level(str(file)).name == "Tiny"


def test_a_missing_level_names_those_there_are():
    with pytest.raises(ValueError, match=r"neither a file nor one of .*ripple"):
        load_level("no-such-level")
    with pytest.raises(ValueError, match="Did you mean 'nested_rings'"):
        load_level("nested-rings")


@pytest.mark.parametrize("name", ["a" * 300, "a" * 5000, "b/" + "a" * 300])
def test_a_name_too_long_for_a_file_is_no_level(name):
    """The system's error came through: [Errno 36] File name too long."""
    env = ArkanoidEnv()
    for call in (
        lambda: load_level(name),
        lambda: ArkanoidEnv(levels=name),
        lambda: ArkanoidEnv(levels=["ripple", name]),
        lambda: env.reset(options={"level": name}),
    ):
        with pytest.raises(ValueError, match=r"no level '.*a\.\.\.': it is neither") as caught:
            call()
        assert len(str(caught.value)) < 600


def test_reach_agrees_with_labelled_regions():
    levels = metallic_levels(4000)
    expected = out_of_reach(levels)
    assert expected.any(axis=(1, 2)).mean() > 0.5
    assert not expected.any(axis=(1, 2)).all()
    before = levels.copy()
    for level, mask in zip(levels, expected, strict=True):
        assert unreachable_bricks(level) == [tuple(cell) for cell in np.argwhere(mask)]
    assert (levels == before).all()


def test_a_search_goes_on_where_a_gap_is_opened():
    """An earlier search stays valid: the generator opens gap after gap."""
    for level in metallic_levels(300).reshape(-1, 198):
        afresh, continued = level.copy(), level.copy()
        search_reachable(continued)
        opened = np.flatnonzero(level == GOLD)[:3]
        afresh[opened] = continued[opened] = 1
        search_reachable(afresh)
        search_reachable(continued)
        assert (afresh == continued).all()


def test_the_campaign():
    levels = [load_level(name) for name in CAMPAIGN]
    assert [item.name for item in levels] == [
        "Ripple",
        "Archway",
        "Honeycomb",
        "Hourglass",
        "Nested Rings",
        "Comb",
        "Islands",
        "Moat",
        "Snowflake",
        "Spiral",
        "Vault",
        "Switchback",
        "Warden",
    ]
    assert sorted(CAMPAIGN) == level_names()
    assert [item.boss for item in levels] == [False] * 12 + [True]
    for number, item in enumerate(levels, 1):
        assert (item.kinds == SILVER).any() == (number >= 4), item.name
        assert (item.kinds == GOLD).any() == (number >= 7), item.name
    outlines = {(item.kinds > 0).tobytes() for item in levels}
    assert len(outlines) == 13


@pytest.mark.parametrize("name", CAMPAIGN)
def test_named_levels_are_sound(name: str):
    item = load_level(name)
    assert item.comment.endswith(".")
    assert len(item.comment) < 90
    assert not out_of_reach(item.kinds[np.newaxis]).any()
    assert set(np.unique(item.kinds)) - {0, SILVER, GOLD}  # not of metal only
    # The top row is free: there is room to play behind the bricks, and no ball is locked in there.
    assert not item.kinds[0].any()


def test_the_boss_has_room():
    warden = load_level(CAMPAIGN[-1])
    for row, column in np.argwhere(warden.kinds):
        # The nearest point of the brick to the boss's place.
        x = np.clip(5.5, column, column + 1)
        top = LATTICE_TOP - row / 2
        y = np.clip(10.0, top - 0.5, top)
        assert np.hypot(x - 5.5, y - 10.0) >= 3.5 - 1e-9


def test_a_boss_needs_no_bricks():
    assert parse_level("boss: yes\n", "lone.txt").boss
    with pytest.raises(ValueError, match="no breakable brick"):
        parse_level("boss: no\n", "lone.txt")


def test_the_documentation_shows_all_named_levels(tmp_path):
    script = runpy.run_path(str(ROOT / "docs" / "pictures" / "levels.py"))
    script["main"](tmp_path)
    for name, pictures in ((script["NAMED"], 13), (script["GENERATED"], 5 * 6)):
        drawn = iio.imread(tmp_path / name)
        assert drawn.shape == iio.imread(ROOT / "docs" / "pictures" / name).shape
        height, width = 206, 192
        tiles = drawn.reshape(drawn.shape[0] // height, height, drawn.shape[1] // width, width, 3)
        tiles = tiles.swapaxes(1, 2).reshape(-1, height * width * 3)
        assert len(np.unique(tiles[tiles.any(axis=1)], axis=0)) == pictures
    text = (ROOT / "docs" / "levels.md").read_text("utf-8")
    for name in CAMPAIGN:
        assert f"| {load_level(name).name} | `{name}` |" in text


def test_the_documentations_level_can_be_played():
    text = (ROOT / "docs" / "levels.md").read_text("utf-8")
    example = text.split("```text\n")[1].split("```")[0]
    assert parse_level(example, "gate.txt").name == "Gate"
