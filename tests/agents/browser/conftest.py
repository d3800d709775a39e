"""The page as a file, and a browser for it, made once."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from arkanoid.agents.cli import main
from helpers.browser import DESKTOP, run_browser, visit


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    with run_browser() as browser:
        yield browser


@pytest.fixture(scope="session")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What `arkanoid web --out` writes."""
    path = tmp_path_factory.mktemp("page") / "game.html"
    assert main(["web", "--out", str(path)]) == 0
    return path


@pytest.fixture
def page(browser: Any, file: Path) -> Iterator[Any]:
    with visit(browser, file.as_uri(), **DESKTOP) as page:
        yield page
