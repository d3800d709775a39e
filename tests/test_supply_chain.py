"""What is installed is what was pinned: every file by its checksum, and the build backend."""

import re

import pytest
from helpers.repository import EXTRAS, PYPROJECT, ROOT
from packaging.requirements import Requirement

LOCKS = {"requirements.txt": "constraints.txt", "requirements-ray.txt": "constraints-ray.txt"}


def lines(file: str) -> list[str]:
    """Return the requirements of a file, each in one line with its options."""
    text = (ROOT / file).read_text(encoding="utf-8").replace("\\\n", " ")
    return [line for line in text.splitlines() if line and not line.startswith("#")]


@pytest.mark.parametrize(("file", "constraints"), LOCKS.items())
def test_every_pin_has_the_checksums_of_its_files(file: str, constraints: str) -> None:
    """If this fails, run `make lock`."""
    pins = []
    for line in lines(file):
        pin, *checksums = re.split(r"\s+--hash=sha256:", line.strip())
        assert checksums, pin
        assert all(re.fullmatch("[0-9a-f]{64}", checksum) for checksum in checksums), pin
        pins.append(pin)
    assert pins == lines(constraints)


def test_the_build_backend_is_pinned() -> None:
    (backend,) = PYPROJECT["build-system"]["requires"]
    assert backend in lines("constraints.txt")
    # A build without isolation needs this very version.
    assert [one for one in EXTRAS["dev"] if Requirement(one).name == "setuptools"] == [backend]
