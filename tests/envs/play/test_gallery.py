"""Levels to look at: list, text, colours, pictures, and the command `arkanoid levels`."""

import io
import re
import sys
from pathlib import Path

import gymnasium as gym
import imageio.v3 as iio
import numpy as np
import pytest
from arkanoid.agents import cli
from arkanoid.envs.draw.palette import BRICK_BODY, PALETTE
from arkanoid.envs.levels import CAMPAIGN, generate_level, parse_level
from arkanoid.envs.play.gallery import (
    COLOURS_256,
    NO_COLOURS,
    PICTURE_COLUMNS,
    TRUE_COLOURS,
    count_bricks,
    draw_levels,
    level_in_colours,
    level_text,
    load_or_generate,
    parse_seed,
    terminal_colours,
)
from helpers.processes import run_program

SGR = re.compile(r"\x1b\[[\d;]*m")
CUBE = np.array([0, 95, 135, 175, 215, 255])


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("name", CAMPAIGN)
def test_a_levels_text_is_its_file(name: str) -> None:
    level = load_or_generate(name)
    again = parse_level(level_text(level), "again.txt")
    assert (again.name, again.comment, again.boss) == (level.name, level.comment, level.boss)
    np.testing.assert_array_equal(again.kinds, level.kinds)


def test_a_level_without_a_comment_shows_none() -> None:
    """An empty heading, or an empty line above the picture, stood for it."""
    text = "name: Plain\n\nwwwwwwwwwww\n"
    level = parse_level(text, "plain.txt")
    assert "comment" not in level_text(level)
    assert "\n\n" not in level_in_colours(level, COLOURS_256)


@pytest.mark.parametrize("difficulty", [0.0, 0.5, 1.0])
def test_a_generated_level_can_be_kept_as_a_file(difficulty: float) -> None:
    for seed in range(30):
        level = load_or_generate(f"seed:{seed}", difficulty)
        expected = generate_level(seed, difficulty=difficulty)
        assert level.name == expected.name
        again = parse_level(level_text(level), "again.txt")
        np.testing.assert_array_equal(again.kinds, expected.kinds)


@pytest.mark.parametrize("name", [*CAMPAIGN, "seed:3"])
def test_bricks_are_counted(name: str) -> None:
    level = load_or_generate(name, 0.9)
    rows = "".join(level_text(level).split("\n\n")[1])
    letters = sum(rows.count(letter) for letter in "wocgrbmyS")
    assert count_bricks(level) == (letters, rows.count("S"), rows.count("X"))


@pytest.mark.parametrize("colours", [COLOURS_256, TRUE_COLOURS])
@pytest.mark.parametrize("name", ["vault", "warden"])
def test_each_kind_of_brick_has_its_own_colour(name: str, colours: int) -> None:
    level = load_or_generate(name)
    _, comment, *rows = level_in_colours(level, colours).split("\n")
    assert comment == level.comment
    assert len(rows) == 18
    inks = []
    for row, kinds in zip(rows, level.kinds, strict=True):
        assert len(SGR.sub("", row)) == 4 * 11
        assert row.endswith("\x1b[0m")
        column = 0
        ink = ""
        for sequence, text in re.findall(r"\x1b\[([\d;]*)m([^\x1b]*)", row):
            ink = sequence.partition(";48;")[0]
            for letter in text:
                if column % 4 == 0 and kinds[column // 4]:
                    inks.append((int(kinds[column // 4]), ink))
                    assert letter == "▀"
                if column % 4 == 1 and kinds[column // 4] >= 9:
                    assert letter == ".wocgrbmySX"[kinds[column // 4]]
                column += 1
    assert len({ink for _, ink in inks}) == len({kind for kind, _ in inks})
    if colours == TRUE_COLOURS:
        for kind, ink in inks:
            red, green, blue = PALETTE[BRICK_BODY + kind].astype(int)
            assert ink == f"38;2;{red};{green};{blue}"


def test_of_256_colours_the_nearest_is_taken() -> None:
    for kind in range(1, 11):
        level = parse_level("." * 5 + ".wocgrbmySX"[kind] + "....w", "one.txt")
        row = level_in_colours(level, COLOURS_256).split("\n")[1]
        code = int(re.findall(r"38;5;(\d+);48;5;\d+m▀", row)[0])
        wanted = [int(np.argmin(abs(CUBE - part))) for part in PALETTE[BRICK_BODY + kind]]
        assert code - 16 == 36 * wanted[0] + 6 * wanted[1] + wanted[2]


def test_colours_are_used_only_where_they_are_wanted_and_shown() -> None:
    assert terminal_colours(io.StringIO(), {"COLORTERM": "truecolor"}) == NO_COLOURS
    assert terminal_colours(Terminal(), {"COLORTERM": "truecolor", "NO_COLOR": "1"}) == NO_COLOURS
    assert terminal_colours(Terminal(), {"TERM": "dumb"}) == NO_COLOURS
    # An empty NO_COLOR says nothing: https://no-color.org
    assert terminal_colours(Terminal(), {"COLORTERM": "24bit", "NO_COLOR": ""}) == TRUE_COLOURS
    assert terminal_colours(Terminal(), {"TERM": "xterm-256color"}) == COLOURS_256


def test_seeds_are_distinguished_from_names() -> None:
    assert parse_seed("spiral") is None
    assert parse_seed("seed:0") == 0
    assert parse_seed(f"seed:{2**63 - 1}") == 2**63 - 1
    for wrong in ("seed:", "seed:-1", "seed:x", "seed: 7", f"seed:{2**63}", "seed:1" + 99 * "0"):
        with pytest.raises(ValueError, match="as in seed:7"):
            parse_seed(wrong)


def test_pictures_show_what_the_environment_shows(tmp_path: Path) -> None:
    file = tmp_path / "mine.txt"
    file.write_text("name: Mine\n\n.w.......X.\n")
    starts = [{"level": "spiral"}, {"seed": 7, "difficulty": 0.9}, {"level": str(file)}]
    env = gym.make("arkanoid:Arkanoid-v0", render_mode="rgb_array")
    expected = []
    for options in starts:
        env.reset(seed=0, options={"level": None, "seed": None} | options)
        expected.append(env.render())
    names = ["spiral", "seed:7", str(file)]
    sheet = draw_levels(names * 2, 0.9)
    height, width, _ = expected[0].shape
    down, across = (sheet.shape[0] + 8) // 2, (sheet.shape[1] + 8) // PICTURE_COLUMNS
    assert (down, across) == (height + 8, width + 8)
    for index in range(6):
        top, left = index // PICTURE_COLUMNS * down, index % PICTURE_COLUMNS * across
        tile = sheet[top : top + height, left : left + width]
        np.testing.assert_array_equal(tile, expected[index % 3])
    assert draw_levels(["comb"], height=64).shape == (64, 48, 3)


def test_the_command_lists_the_named_levels(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["levels"]) == 0
    printed = capsys.readouterr().out
    assert [line.split()[0] for line in printed.split("\n")[1:14]] == list(CAMPAIGN)
    assert "seed:7" in printed


def test_redirected_the_command_writes_a_level_file(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert cli.main(["levels", "seed:5", "--difficulty", "1"]) == 0
    file = tmp_path / "mine.txt"
    file.write_text(capsys.readouterr().out)
    expected = generate_level(5, difficulty=1.0)
    np.testing.assert_array_equal(load_or_generate(str(file)).kinds, expected.kinds)
    assert cli.main(["levels", "comb", "warden"]) == 0
    printed = capsys.readouterr().out
    assert (
        printed
        == level_text(load_or_generate("comb"))
        + "\n\n"
        + level_text(load_or_generate("warden"))
        + "\n"
    )


def test_in_a_terminal_the_command_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stdout", terminal)
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("COLORTERM", "truecolor")
    assert cli.main(["levels", "comb"]) == 0
    assert terminal.getvalue() == level_in_colours(load_or_generate("comb"), TRUE_COLOURS) + "\n"


def test_the_command_draws_into_files(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "all.png"
    assert cli.main(["levels", "--png", str(path)]) == 0
    assert capsys.readouterr().out == f"{path}\n"
    np.testing.assert_array_equal(iio.imread(path), draw_levels(CAMPAIGN))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["spirol"], "Did you mean 'spiral'"),
        (["seed:no"], "asked for as seed:7"),
        (["seed:1", "--difficulty", "2"], "--difficulty: must be a number, from 0 to 1"),
        (["comb", "--png", "no/such/folder/x.png"], "no/such/folder: there is no such folder"),
        (["."], "no level '.'"),
    ],
)
def test_mistakes_are_one_line_each(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["levels", *arguments]) == 2
    message = capsys.readouterr().err
    assert message.startswith("arkanoid: error: ")
    assert message.count("\n") == 1
    assert words in message


def test_a_mistake_in_a_file_is_named_with_its_line(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    file = tmp_path / "mine.txt"
    file.write_text("name: Mine\n\n.k.........\n")
    assert cli.main(["levels", str(file)]) == 2
    assert f"{file}, line 3, column 2: 'k' is no brick" in capsys.readouterr().err
    file.write_bytes(b"\xff\xfe\x00")
    assert cli.main(["levels", str(file)]) == 2
    assert "mine.txt" in capsys.readouterr().err


def test_no_extra_is_needed() -> None:
    program = (
        "import sys\n"
        "for name in ('torch', 'stable_baselines3', 'imageio', 'PIL', 'pygame', 'tqdm', 'rich'):\n"
        "    sys.modules[name] = None\n"
        "from arkanoid.agents.cli import main\n"
        "sys.exit(main(['levels', 'comb']))"
    )
    printed = run_program(program, warnings="default").stdout
    assert printed == level_text(load_or_generate("comb")) + "\n"
