"""Entries on another processor, an AArch64, have the bits of this one."""

import numpy as np
import pytest
from arkanoid.physics.kernels.portable import Entry
from helpers import entries
from helpers.arm import FIRST, ArmMachine, make_program

ENTRIES = [Entry("helpers.entries", name) for name in ("roots", "integers", "turn")]
RANDOM = np.random.default_rng(3)
JOBS = [
    *(("roots", index, RANDOM.uniform(0, 100, 4)) for index in range(4)),
    *(("turn", index, RANDOM.normal(size=4)) for index in range(4)),
    *(("integers", index, np.array([0, 0, 0, 11 - 9 * index])) for index in range(4)),
]


def test_numbers_are_those_of_this_processor(tmp_path_factory: pytest.TempPathFactory) -> None:
    machine = ArmMachine(make_program(ENTRIES, tmp_path_factory.mktemp("arm")), ENTRIES)
    wanted = []
    for name, index, numbers in JOBS:
        machine.put(FIRST, numbers.tobytes())
        machine.call(name, FIRST, index)
        machine.get(FIRST, numbers.nbytes)
        here = numbers.copy()
        getattr(entries, name)(index, here.ctypes.data)
        wanted.append(here.tobytes())
    assert machine.run() == b"".join(wanted)
