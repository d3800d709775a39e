"""What the tests of the kernels' compiler share."""

from pathlib import Path

import pytest
from helpers.scratch_package import Scratch


@pytest.fixture
def scratch(tmp_path: Path) -> Scratch:
    """Return a scratch package and an empty cache."""
    return Scratch(tmp_path)
