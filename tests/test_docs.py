"""What the documentation says is true: its code runs and prints what it says, its links exist.

And the figures that are committed are those that the engine draws today.
"""

import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
PAGES = sorted(DOCS.glob("*.md"))
EXAMPLES = sorted((DOCS / "examples").glob("*.py"))
# These need packages that the tests have not: `make compat` and `make ray` run them.
PEERS = sorted((DOCS / "examples" / "peers").glob("*.*"))
FIGURES = sorted((DOCS / "figures").glob("*.svg"))
LARGEST_FIGURE = 200_000  # bytes
MEASURE = 0.05  # points: what is drawn less than that apart looks the same


def relative(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def python(*arguments: str | Path, cwd: Path) -> str:
    """Run Python with warnings as errors, and return what it prints."""
    done = subprocess.run(
        [sys.executable, "-W", "error", *arguments],
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def python_blocks(page: str) -> str:
    """Return a page's Python as one program, every line with the number that it has in the page."""
    lines = []
    inside = False
    for line in page.splitlines():
        fence = line.startswith("```")
        lines.append(line if inside and not fence else "")
        if fence:
            inside = line == "```python"
    return "\n".join(lines)


def promises(program: str) -> list[str]:
    """Return what a program says beside its prints: ``print(1 + 1)  # 2``."""
    return re.findall(r"^print\(.*\)  # (.+)$", program, flags=re.MULTILINE)


@pytest.mark.parametrize("page", PAGES, ids=relative)
def test_code_of_a_page_runs_and_prints_what_it_says(page: Path, tmp_path: Path) -> None:
    """The blocks of a page run one after the other, as someone who reads it would run them."""
    program = python_blocks(page.read_text(encoding="utf-8"))
    if not program.strip():
        return
    script = tmp_path / f"{page.stem}.py"
    script.write_text(program, encoding="utf-8")
    printed = iter(python(script, cwd=tmp_path).splitlines())
    for promise in promises(program):
        assert promise in printed, f"{page.name} promises: {promise}"


def test_a_broken_promise_is_noticed() -> None:
    page = "Text\n```python\nprint(1)  # 1\n```\n```sh\nprint\n```\n```python\nprint(2)\n```\n"
    assert python_blocks(page) == "\n\nprint(1)  # 1\n\n\n\n\n\nprint(2)\n"
    assert promises(python_blocks(page)) == ["1"]
    assert "3" not in iter(["1", "2"])


@pytest.mark.parametrize("example", EXAMPLES, ids=relative)
def test_example_runs(example: Path, tmp_path: Path) -> None:
    assert python(example, cwd=tmp_path).strip()


def links(page: Path) -> list[tuple[str, str]]:
    """Return (path, anchor) of every link to a file and every picture of a page."""
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    return [
        (path, anchor)
        for path, anchor in re.findall(r"\]\(([^)#\s]*)#?([^)\s]*)\)", text)
        if not path.startswith(("http://", "https://"))
    ]


def anchors(page: Path) -> set[str]:
    """Return the anchors that GitHub gives a page's headings."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=relative)
def test_links_of_a_page_lead_somewhere(page: Path) -> None:
    for path, anchor in links(page):
        target = page.parent / path if path else page
        assert target.exists(), path
        assert not anchor or anchor in anchors(target), f"{path}#{anchor}"


def test_every_page_example_and_figure_is_linked() -> None:
    linked = {
        (page.parent / path).resolve()
        for page in [*PAGES, ROOT / "README.md"]
        for path, _ in links(page)
    }
    assert [
        relative(file) for file in [*PAGES, *EXAMPLES, *PEERS, *FIGURES] if file not in linked
    ] == []


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


@pytest.fixture(scope="module")
def redrawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder into which the script has just drawn every figure."""
    folder = tmp_path_factory.mktemp("figures")
    python(DOCS / "figures.py", folder, cwd=folder)
    return folder


def test_every_figure_is_committed(redrawn: Path) -> None:
    assert [figure.name for figure in FIGURES] == sorted(file.name for file in redrawn.iterdir())
    assert all(figure.stat().st_size < LARGEST_FIGURE for figure in FIGURES)


@pytest.mark.parametrize("figure", FIGURES, ids=relative)
def test_figure_is_what_the_engine_draws(figure: Path, redrawn: Path) -> None:
    """If it is not: look at it, and draw it anew with ``python docs/figures.py``."""
    old, new = drawn(figure), drawn(redrawn / figure.name)
    assert list(old) == list(new) != []
    for name, coordinates in old.items():
        np.testing.assert_allclose(new[name], coordinates, rtol=0, atol=MEASURE, err_msg=name)


@pytest.mark.parametrize("figure", FIGURES, ids=relative)
def test_letters_of_a_figure_have_their_size(figure: Path) -> None:
    """When two digits were kept of every number, letters were 28 % too large for their places.

    A glyph's own units are 1/64; rounded to 0.02 they made it run into its neighbours.
    """
    scales = re.findall(r'transform="scale\(([^)]*)\)"', figure.read_text(encoding="utf-8"))
    assert {float(scale) for scale in scales} == {1 / 64}
