"""Links between the pages and to the repository's files lead somewhere."""

import re
from pathlib import Path

import pytest
from helpers.notebooks import cells
from helpers.pages import PAGES, anchors, links, relative
from helpers.repository import DOCS, EXAMPLES

TO_BE_LINKED = [
    *(page for page in PAGES if page.is_relative_to(DOCS)),
    *EXAMPLES.glob("*.py"),
    *EXAMPLES.glob("*.ipynb"),
    *EXAMPLES.glob("peers/*.*"),
    *DOCS.glob("figures/*.svg"),
]


@pytest.mark.parametrize("page", PAGES, ids=relative)
def test_links_of_a_page_lead_somewhere(page: Path) -> None:
    for path, anchor in links(page):
        target = page.parent / path if path else page
        assert target.exists(), path
        assert not anchor or anchor in anchors(target), f"{path}#{anchor}"


def test_links_of_the_notebook_lead_somewhere() -> None:
    notebook = EXAMPLES / "first_hour.ipynb"
    targets = re.findall(r"\]\(([^)]+)\)", "".join(cells(notebook, "markdown")))
    assert len(targets) == 2
    assert [target for target in targets if not (EXAMPLES / target).exists()] == []


def test_every_page_example_and_figure_is_linked() -> None:
    linked = {(page.parent / path).resolve() for page in PAGES for path, _ in links(page)}
    assert [relative(file) for file in TO_BE_LINKED if file not in linked] == []
