"""The environments' page is what the code says today."""

import subprocess
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent.parent / "docs"


def test_the_page_is_what_its_script_writes(tmp_path: Path) -> None:
    """If not: python docs/environment_page.py."""
    written = tmp_path / "page.md"
    done = subprocess.run(
        [sys.executable, "-W", "error", DOCS / "environment_page.py", written],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert written.read_text("utf-8") == (DOCS / "environment.md").read_text("utf-8")
