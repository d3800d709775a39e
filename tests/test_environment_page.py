"""The environments' page is what the code says today."""

from pathlib import Path

from helpers.processes import run_python
from helpers.repository import DOCS


def test_the_page_is_what_its_script_writes(tmp_path: Path) -> None:
    """If not: python docs/environment_page.py."""
    written = tmp_path / "page.md"
    run_python(DOCS / "environment_page.py", written)
    assert written.read_text("utf-8") == (DOCS / "environment.md").read_text("utf-8")
