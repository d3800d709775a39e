"""What can be tested without RLlib. `make ray` does the rest, in an environment of its own."""

import re

from helpers.processes import run_python
from helpers.repository import ROOT, TESTS

SCRIPT = TESTS / "cluster" / "run.py"


def test_help_needs_no_ray() -> None:
    assert "episodes, training, nodes, scaling" in run_python(SCRIPT, "--help").stdout


def test_an_unknown_part_is_refused_before_anything_runs() -> None:
    done = run_python(SCRIPT, "episodes", "scalling", status=2)
    assert "no part 'scalling'; there are episodes, training, nodes, scaling" in done.stderr


def test_the_kept_output_is_of_the_pinned_versions() -> None:
    """If not: make ray, and copy what it prints into docs/results/cluster.txt."""
    pins = dict(line.split(" ")[0].split("==") for line in read_lines("constraints-ray.txt"))
    output = "\n".join(read_lines("docs/results/cluster.txt"))
    printed = re.search(r"^\w+, Python [\d.]+, (ray .*)$", output, re.MULTILINE)
    assert printed
    versions = dict(package.split(" ") for package in printed[1].split(", "))
    # A build of torch for processors only has a longer version: 2.13.0+cpu.
    assert {name: version.partition("+")[0] for name, version in versions.items()} == {
        name: pins[name] for name in ("ray", "gymnasium", "torch", "numpy", "numba")
    }
    assert "All is as it should be." in output


def read_lines(file: str) -> list[str]:
    """Return a file's lines but for comments."""
    lines = (ROOT / file).read_text(encoding="utf-8").splitlines()
    return [line for line in lines if not line.startswith("#")]
