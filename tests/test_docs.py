"""The documentation's code prints what the pages say, and its figures are up to date."""

import importlib
import itertools
import re
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from helpers.notebooks import outputs, write_program
from helpers.pages import PAGES, program, relative
from helpers.processes import run_python
from helpers.repository import DOCS, EXAMPLES, ROOT

FIGURES = sorted((DOCS / "figures").glob("*.svg"))
MEASURE = 0.05  # points: smaller differences cannot be seen


def promises(text: str) -> list[str]:
    """Return what a program says beside its prints: ``print(1 + 1)  # 2``."""
    return re.findall(r"^print\(.*\)  # (.+)$", text, flags=re.MULTILINE)


@pytest.mark.parametrize("page", [page for page in PAGES if program(page).strip()], ids=relative)
def test_code_of_a_page_runs_and_prints_what_it_says(page: Path, tmp_path: Path) -> None:
    """The blocks of a page run one after the other, as a reader would run them."""
    script = tmp_path / f"{page.stem}.py"
    script.write_text(program(page), encoding="utf-8")
    printed = iter(run_python(script, cwd=tmp_path).stdout.splitlines())
    for promise in promises(program(page)):
        assert promise in printed, f"{page.name} promises: {promise}"


def test_a_broken_promise_is_noticed(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    text = "Text\n```python\nprint(1)  # 1\n```\n```sh\nprint\n```\n```python\nprint(2)\n```\n"
    page.write_text(text, encoding="utf-8")
    assert program(page) == "\n\nprint(1)  # 1\n\n\n\n\n\nprint(2)\n"
    assert promises(program(page)) == ["1"]
    assert "3" not in iter(["1", "2"])


# Those in `peers` need packages that the tests lack: `make compat` and `make ray` run them.
@pytest.mark.parametrize("example", sorted(EXAMPLES.glob("*.py")), ids=relative)
def test_example_runs(example: Path, tmp_path: Path) -> None:
    assert run_python(example, cwd=tmp_path).stdout.strip()


def test_the_film_of_the_platformer_is_what_it_draws(tmp_path: Path) -> None:
    """If it is not: run the example, look at the film, and copy it to docs/pictures."""
    run_python(EXAMPLES / "platformer.py", cwd=tmp_path)
    old, new = (numbers(folder / "platformer.svg") for folder in (DOCS / "pictures", tmp_path))
    np.testing.assert_allclose(new, old, rtol=0, atol=0.02)  # hundredths of a tile are drawn


@pytest.mark.parametrize("height", range(0, 12, 2))
def test_the_hero_of_the_platformer_walks_over_every_seam(
    height: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """He stopped dead where two tiles met if rounding let him overlap the next one by a digit."""
    monkeypatch.syspath_prepend(EXAMPLES)
    platformer = importlib.import_module("platformer")
    floor = "\n.P......................\n########################\n"
    monkeypatch.setattr(platformer, "LEVEL", floor + "#.......................\n" * height)
    for tall, speed in itertools.product((0.2, 0.3, 0.7, 0.9), (1.0, 3.3, 4.0)):
        monkeypatch.setitem(platformer.MARKS, "P", ("", 0.6, tall))
        monkeypatch.setattr(platformer, "WALK", speed)
        game = platformer.Game()
        game.world.place(game.hero, position=(1.0, height + 0.5 + 0.5 * tall))
        for tick in range(1, 240):
            game.tick("right")
            x, y = game.world.body(game.hero).position
            assert x == pytest.approx(1.0 + speed * tick * platformer.TICK, abs=1e-9)
            assert y == pytest.approx(height + 0.5 + 0.5 * tall, abs=1e-9)


def test_nobody_in_the_crowd_overlaps_and_all_are_drawn(tmp_path: Path) -> None:
    """What a crowd does hangs on the last digit of everything, so its shapes are only counted."""
    printed = run_python(EXAMPLES / "crowd.py", cwd=tmp_path).stdout.splitlines()
    gaps = [float(line.rpartition(" ")[2]) for line in printed]
    assert len(gaps) == 4
    assert min(gaps) >= 0.0
    old, new = (
        Counter(part.tag for part in ElementTree.parse(folder / "crowd.svg").iter())
        for folder in (DOCS / "pictures", tmp_path)
    )
    assert old == new


def test_every_exercise_has_an_answer_that_is_folded_away() -> None:
    page = (DOCS / "engine.md").read_text(encoding="utf-8")
    exercises = [int(number) for number in re.findall(r"^\*\*Exercise (\d+)\.", page, re.MULTILINE)]
    assert exercises == list(range(1, len(exercises) + 1)) != []
    answer = r"<details>\n<summary>Answer</summary>\n\n.+?\n\n</details>\n"
    assert len(re.findall(answer, page, re.DOTALL)) == len(exercises)
    assert page.count("<details") == page.count("</details>") == len(exercises)


def test_the_notebook_runs_from_top_to_bottom(tmp_path: Path) -> None:
    """As a newcomer would run it, but with a short training; it shows two games, films and SVG."""
    notebook = EXAMPLES / "first_hour.ipynb"
    script = write_program(notebook, tmp_path, DECISIONS=20_000, GAMES=2)
    printed = run_python(script, cwd=tmp_path).stdout.splitlines()
    shown = [line.removeprefix("shown: ") for line in printed if line.startswith("shown: ")]
    assert shown == ["png", "png", "gif", "gif", "svg"]
    assert outputs(notebook) == []  # a film of an old version would be shown until it is run


def test_figures_of_the_readme_are_measured_ones() -> None:
    """The figures of the README's table stand in the kept outputs and reports."""
    results = [*DOCS.glob("results/*.txt"), *DOCS.glob("results/*.md")]
    kept = " ".join(path.read_text(encoding="utf-8") for path in results)
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    table = readme.partition("## In figures")[2].partition("\n\n[")[0]
    cells = [cell for row in table.splitlines() if row for cell in row.split("|")[2:]]
    number = r"(?<![\w.])\d+(?:,\d{3})*(?:\.\d+)?(?:e-\d+)?(?!\w)"
    figures = {figure for cell in cells for figure in re.findall(number, cell)}
    assert len(figures) > 10
    assert figures - set(re.findall(number, kept)) == set()


def numbers(picture: Path) -> np.ndarray:
    """Return all numbers of a picture's text in order."""
    text = picture.read_text(encoding="utf-8")
    return np.array(re.findall(r"-?\d*\.?\d+", text), float)


def drawn(figure: Path) -> dict[str, np.ndarray]:
    """Return the coordinates of everything in a figure that has a name of ours.

    Letters are left out: how a font is drawn is not what the figure says.
    """
    shapes = {}
    for group in ElementTree.parse(figure).iter("{http://www.w3.org/2000/svg}g"):
        name = group.get("id", "")
        if "." in name and not name.startswith("matplotlib"):
            paths = [path.get("d", "") for path in group.iter("{http://www.w3.org/2000/svg}path")]
            numbers = re.findall(r"-?\d+(?:\.\d+)?", " ".join(paths))
            shapes[name] = np.array(numbers, float)
    return shapes


def test_figures_are_what_the_engine_draws(tmp_path: Path) -> None:
    """If one is not: look at it, and draw it again with ``python docs/figures.py``."""
    run_python(DOCS / "figures.py", tmp_path)
    assert [figure.name for figure in FIGURES] == sorted(file.name for file in tmp_path.iterdir())
    for figure in FIGURES:
        old, new = drawn(figure), drawn(tmp_path / figure.name)
        assert list(old) == list(new) != []
        for name, coordinates in old.items():
            message = f"{figure.name}: {name}"
            np.testing.assert_allclose(
                new[name], coordinates, rtol=0, atol=MEASURE, err_msg=message
            )
