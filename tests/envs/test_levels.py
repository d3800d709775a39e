"""Level files: what is read, and what is refused with its place."""

import numpy as np
import pytest
from arkanoid.envs.rounds import level_table, load_round, named_rounds, parse_round

GOOD = "name: Tiny\ncomment: two bricks\n\n.w.......X.\n"


def test_a_level_is_read_row_by_row_from_the_top():
    tiny = parse_round(GOOD, "tiny.txt")
    assert (tiny.name, tiny.comment) == ("Tiny", "two bricks")
    assert tiny.kinds.shape == (18, 11)
    assert np.argwhere(tiny.kinds).tolist() == [[0, 1], [0, 9]]
    assert (tiny.kinds[0, 1], tiny.kinds[0, 9]) == (1, 10)


@pytest.mark.parametrize("name", named_rounds())
def test_packaged_levels_are_sound(name):
    level = load_round(name)
    assert level.name
    assert level.comment
    assert level.kinds.any()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name: A\n\n.w.\n", r"a.txt, line 3: 3 characters; a row of bricks has 11"),
        ("name: A\n\n.w.......?.\n", r"a.txt, line 3, column 10: '\?' is no brick"),
        ("author: me\n", r"a.txt, line 1: unknown heading 'author'"),
        ("name: A\n\n" + "wwwwwwwwwww\n" * 19, r"a.txt: 19 rows of bricks; at most 18"),
        ("name: A\n\nX..........\n", r"a.txt: there is no breakable brick"),
        ("", r"a.txt: there is no breakable brick"),
    ],
)
def test_malformed_levels_are_refused(text, message):
    with pytest.raises(ValueError, match=message):
        parse_round(text, "a.txt")


def test_a_level_file_of_ones_own(tmp_path):
    file = tmp_path / "mine.txt"
    file.write_text(GOOD)
    assert load_round(str(file)).name == "Tiny"
    table = level_table(["ripple", str(file)])
    assert table.shape == (2,)
    assert (table[1].kind > 0).sum() == 2


def test_a_missing_level_names_those_there_are():
    with pytest.raises(ValueError, match=r"neither a file nor one of .*ripple"):
        load_round("no-such-level")
