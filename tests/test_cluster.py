"""What can be said of RLlib without it. The rest is `make ray`, in an environment of its own."""

import re

from helpers.processes import run_python
from helpers.repository import ROOT, TESTS

SCRIPT = TESTS / "cluster" / "run.py"


def test_help_needs_no_ray() -> None:
    assert "episodes, training, nodes, scaling" in run_python(SCRIPT, "--help").stdout


def test_an_unknown_part_is_refused_before_anything_runs() -> None:
    done = run_python(SCRIPT, "episodes", "scalling", status=2)
    assert "no part 'scalling'; there are episodes, training, nodes, scaling" in done.stderr


def test_the_page_shows_what_the_pinned_versions_printed() -> None:
    """If not: make ray, and copy what it prints into docs/cluster.md."""
    lines = (ROOT / "constraints-ray.txt").read_text(encoding="utf-8").splitlines()
    pins = dict(line.split("==") for line in lines if not line.startswith("#"))
    page = (ROOT / "docs" / "cluster.md").read_text(encoding="utf-8")
    printed = re.search(r"^\w+, Python [\d.]+, (ray .*)$", page, re.MULTILINE)
    assert printed
    versions = dict(package.split(" ") for package in printed[1].split(", "))
    # A build of torch for the processor alone says so: 2.13.0+cpu.
    assert {name: version.partition("+")[0] for name, version in versions.items()} == {
        name: pins[name] for name in ("ray", "gymnasium", "torch", "numpy", "numba")
    }
    assert "All is as it should be." in page
