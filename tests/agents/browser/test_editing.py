"""The editor in a real browser: painting, files, and whether a level can be cleared."""

from pathlib import Path
from typing import Any

import pytest
from arkanoid.envs.levels import load_level
from arkanoid.envs.levels.generated import generate_level
from arkanoid.envs.rules import BRICK_LETTERS, CELLS, COLUMNS
from helpers.browser import PHONE, visit, wait_until

# A blue brick within gold.
BARRED = """name: Barred

...........
.XXX.......
.XbX.......
.XXX....rrr
"""


def letters(name_or_path: str | Path) -> str:
    return "".join(BRICK_LETTERS[kind] for kind in load_level(str(name_or_path)).kinds.ravel())


def bricks(page: Any) -> str:
    return page.evaluate("arkanoid.part._level.bricks")


@pytest.fixture
def editor(page: Any) -> Any:
    """The page's editor with an empty field."""
    page.get_by_role("link", name="Editor").click()
    wait_until(page, "part?.game && part.still")
    page.get_by_role("button", name="Clear").click()
    assert set(bricks(page)) == {"."}
    return page


def place(page: Any, row: int, column: int) -> tuple[float, float]:
    """Return where the middle of a cell is on the page."""
    box = page.locator("#picture").bounding_box()
    unit = box["width"] / 12
    return box["x"] + (column + 1) * unit, box["y"] + (3.25 + row / 2) * unit


def put(page: Any, name: str, text: str) -> None:
    file = {"name": name, "mimeType": "text/plain", "buffer": text.encode()}
    page.locator("#level-file").set_input_files(file)


def test_painting_with_the_mouse(editor: Any) -> None:
    editor.get_by_label("silver").check()
    editor.get_by_label("Mirror").check()
    editor.mouse.move(*place(editor, 2, 1))
    editor.mouse.down()
    editor.mouse.move(*place(editor, 2, 3), steps=6)
    editor.mouse.up()
    assert bricks(editor)[2 * COLUMNS : 3 * COLUMNS] == ".SSS...SSS."
    kinds = editor.evaluate("Array.from(arkanoid.part.game.world.kind)")
    assert "".join(BRICK_LETTERS[kind] for kind in kinds) == bricks(editor)
    editor.get_by_role("button", name="Undo").click()
    assert set(bricks(editor)) == {"."}
    editor.get_by_role("button", name="Redo").click()
    assert bricks(editor).count("S") == 6


def test_a_fast_pointer_leaves_no_gaps(editor: Any) -> None:
    """It passed over cells between two events, which stayed empty."""
    editor.get_by_label("silver").check()
    editor.mouse.move(*place(editor, 2, 1))
    editor.mouse.down()
    editor.mouse.move(*place(editor, 2, 9))
    editor.mouse.move(*place(editor, 8, 9))
    editor.mouse.up()
    assert bricks(editor)[2 * COLUMNS : 3 * COLUMNS] == ".SSSSSSSSS."
    assert bricks(editor)[9 : 9 * COLUMNS : COLUMNS] == "..SSSSSSS"
    # The next stroke begins where it begins.
    editor.mouse.move(*place(editor, 16, 0))
    editor.mouse.down()
    editor.mouse.up()
    assert bricks(editor).count("S") == 9 + 6 + 1
    editor.get_by_role("button", name="Undo").click()
    editor.get_by_role("button", name="Undo").click()
    assert set(bricks(editor)) == {"."}


def test_touches_are_strokes_of_their_own(browser: Any, file: Path) -> None:
    with visit(browser, f"{file.as_uri()}#editor", **PHONE) as page:
        wait_until(page, "part?.game && part.still")
        page.get_by_role("button", name="Clear").tap()
        for cell in ((3, 1), (15, 9)):
            page.touchscreen.tap(*place(page, *cell))
        assert CELLS - bricks(page).count(".") == 2


def test_painting_by_keys_alone(editor: Any) -> None:
    editor.locator("#picture").focus()
    editor.keyboard.press("ArrowDown")
    for letter in "bX":
        editor.keyboard.press(letter)
        editor.keyboard.press("Space")
        editor.keyboard.press("ArrowRight")
    assert bricks(editor)[:COLUMNS] == ".....bX...."
    assert editor.locator("#said").text_content() == "Row 1, column 8: empty"
    editor.keyboard.press("Control+z")
    assert bricks(editor)[:COLUMNS] == ".....b....."
    editor.keyboard.press("Control+y")
    assert bricks(editor)[:COLUMNS] == ".....bX...."


def test_painting_by_touch(browser: Any, file: Path) -> None:
    with visit(browser, f"{file.as_uri()}#editor", **PHONE) as page:
        assert page.evaluate("document.documentElement.scrollWidth") == 390
        page.get_by_role("button", name="Clear").click()
        page.touchscreen.tap(*place(page, 4, 7))
        page.touchscreen.tap(*place(page, 5, 2))
        assert bricks(page).count("r") == 2
        assert bricks(page)[4 * COLUMNS + 7] == "r"
        page.get_by_role("button", name="Undo").click()
        assert bricks(page).count("r") == 1


def test_files_come_and_go_as_python_reads_them(editor: Any, tmp_path: Path) -> None:
    """Every round, opened and downloaded, has the same bricks; so has one that is painted."""
    for name in ("switchback", "warden"):
        level = load_level(name)
        letters_ = letters(name)
        rows = [letters_[at : at + COLUMNS] for at in range(0, len(letters_), COLUMNS)]
        boss = "boss: yes\n" if level.boss else ""
        put(editor, f"{name}.txt", f"name: {level.name}\ncomment: A: b\n{boss}\n" + "\n".join(rows))
        wait_until(editor, f"part._level.name === {level.name!r}")
        assert bricks(editor) == letters_
        editor.get_by_text("Level files", exact=True).click()
        with editor.expect_download() as download:
            editor.get_by_role("button", name="Download").click()
        editor.get_by_text("Level files", exact=True).click()
        path = tmp_path / download.value.suggested_filename
        assert path.name == f"{name}.txt"
        download.value.save_as(path)
        assert letters(path) == letters_
        assert load_level(str(path)).boss == level.boss
        assert load_level(str(path)).name == level.name


@pytest.mark.parametrize(
    ("text", "sentence"),
    {
        "name: Odd\n\n.rq........\n": "This is no level: line 3: “q” is no brick.",
        "rrr\n": "This is no level: line 1: a row has 11 letters.",
        "title: Odd\n": "This is no level: line 1: headings are name, comment, boss.",
        "boss: 1\n": "This is no level: line 1: boss is yes or no.",
        "." * (1 << 20) + ".": "This is no level: the file is too large.",
        ("r" * 11 + "\n") * 19: "This is no level: 18 rows fit the field.",
    }.items(),
)
def test_files_that_are_no_levels(editor: Any, text: str, sentence: str) -> None:
    put(editor, "odd.txt", text)
    wait_until(editor, "document.getElementById('level-fault').textContent")
    assert editor.locator("#level-fault").text_content() == sentence


def test_a_file_that_is_opened_again_and_names_that_nobody_sees(
    editor: Any, tmp_path: Path
) -> None:
    """Browsers do not tell of the same file twice; and Python refuses letters that nobody sees."""
    path = tmp_path / "twice.txt"
    for row in ("r" * COLUMNS, "b" * COLUMNS):
        path.write_text(f"comment: \U0001f468\u200d\U0001f469\n\n{row}\n", "utf-8")
        editor.locator("#level-file").set_input_files(path)
        wait_until(editor, f"part._level.bricks.startsWith('{row}')")
    editor.get_by_text("Level files", exact=True).click()
    assert editor.get_by_label("Name").input_value() == "twice"
    editor.get_by_label("Name").fill("A\u200db\u00a0c")
    with editor.expect_download() as download:
        editor.get_by_role("button", name="Download").click()
    download.value.save_as(path)
    level = load_level(str(path))
    assert (level.name, level.comment) == ("Ab c", "\U0001f468\U0001f469")


def test_a_stroke_that_begins_where_nothing_changes(editor: Any) -> None:
    """What it changed later could not be undone, and the undo before it was lost."""
    for _ in range(2):
        editor.mouse.move(*place(editor, 2, 1))
        editor.mouse.down()
        editor.mouse.up()
    editor.mouse.down()
    editor.mouse.move(*place(editor, 2, 3), steps=6)
    editor.mouse.up()
    assert bricks(editor).count("r") == 3
    editor.get_by_role("button", name="Undo").click()
    assert bricks(editor).count("r") == 1
    editor.get_by_role("button", name="Undo").click()
    assert set(bricks(editor)) == {"."}


def test_what_nobody_can_clear_is_told_at_once(editor: Any) -> None:
    clearable, plays = editor.locator("#clearable"), editor.get_by_role("button", name="Play it")
    assert clearable.text_content() == "There is nothing to break yet."
    assert plays.is_disabled()
    put(editor, "barred.txt", BARRED)
    wait_until(editor, "part._level.name === 'Barred'")
    assert "1 brick behind gold is out of reach" in clearable.text_content()
    assert plays.is_disabled()
    assert editor.evaluate("arkanoid.part._barred") == [2 * COLUMNS + 2]
    editor.get_by_label("empty").check()
    editor.mouse.click(*place(editor, 2, 1))
    assert clearable.text_content() == "It can be cleared: 4 bricks, and all can be reached."
    assert plays.is_enabled()


def test_an_agent_tries_and_one_plays(editor: Any) -> None:
    editor.mouse.click(*place(editor, 10, 4))
    editor.get_by_role("button", name="Let full try 20 times").click()
    wait_until(editor, "document.getElementById('tries').textContent.includes('of 20')")
    cleared = int(editor.locator("#tries").text_content().split()[1])
    assert cleared >= 15  # one brick
    editor.get_by_role("button", name="Play it").click()
    wait_until(editor, "part.phase === 'ready'")
    assert editor.evaluate("arkanoid.part.game.world.bricks_left") == 1
    editor.get_by_role("link", name="Editor").click()
    wait_until(editor, "part.still")
    assert bricks(editor).count("r") == 1


def test_generated_levels_are_those_of_python(editor: Any) -> None:
    editor.get_by_label("Motif").select_option("rings")
    editor.get_by_label("Number", exact=True).fill("23")
    editor.get_by_role("button", name="Generate").click()
    level = generate_level(23, difficulty=0.5, motif="rings")
    assert bricks(editor) == "".join(BRICK_LETTERS[kind] for kind in level.kinds.ravel())
