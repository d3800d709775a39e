"""Entries for browsers: what their module does and exports, its linker, and how it is kept."""

from pathlib import Path

import numpy as np
import pytest
from arkanoid.physics.kernels.portable import Entry, wasm
from helpers import entries
from helpers.node import run_jobs

ENTRIES = [Entry("helpers.entries", name) for name in ("roots", "integers", "turn")]
JOBS = [
    {"entry": "roots", "index": 1, "numbers": [2.0, 3.0, 5.0, 7.0], "integers": False},
    {"entry": "roots", "index": 3, "numbers": [2.0, 3.0, 5.0, 7.1], "integers": False},
    {"entry": "integers", "index": 5, "numbers": [0, 0, 0, 11], "integers": True},
    {"entry": "integers", "index": 0, "numbers": [0, 0, 0, -13], "integers": True},
    {"entry": "turn", "index": 2, "numbers": [0.5, 1.5, 2.5, 3.5], "integers": False},
    {"entry": "turn", "index": 3, "numbers": [0.5, 1.5, 2.5, 3.5], "integers": False},
]


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> dict:
    """Return what the jobs led to."""
    folder = tmp_path_factory.mktemp("wasm")
    (folder / "module.wasm").write_bytes(wasm.make_wasm(ENTRIES))
    script = Path(__file__).with_name("run.mjs")
    return run_jobs(script, folder, JOBS, folder / "module.wasm")


def test_numbers_are_those_of_this_processor(done: dict) -> None:
    """Arrays in memory have pointers of 32 bits there, and of 64 bits here."""
    for job, found in zip(JOBS, done["results"], strict=True):
        numbers = np.array(job["numbers"], np.int64 if job["integers"] else np.float64)
        getattr(entries, job["entry"])(job["index"], numbers.ctypes.data)
        assert found == numbers.tolist(), job


def test_the_module_exports_entries_and_memory(done: dict) -> None:
    assert sorted(done["exports"]) == sorted(["memory", *(entry.name for entry in ENTRIES)])
    assert done["first"] == wasm.FREE_FROM


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[int]:
    """Let modules be made at once, into a cache of its own; return a list that grows each time."""
    made: list[int] = []

    def link(linker: object, compiled: bytes) -> bytes:
        made.append(len(made))
        return b"module %d" % len(made)

    monkeypatch.setenv("ARKANOID_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(wasm, "compile_entries", lambda entries, optimised: "")
    monkeypatch.setattr(wasm, "_assemble", lambda code, entries: b"")
    monkeypatch.setattr(wasm, "_link", link)
    return made


def test_it_is_made_once(quick: list[int]) -> None:
    assert [wasm.make_wasm(ENTRIES) for _ in range(3)] == [b"module 1"] * 3
    assert wasm.make_wasm(ENTRIES[:1]) == b"module 2"


def test_without_a_linker(quick: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wasm, "find_spec", lambda name: None)
    monkeypatch.setattr(wasm.shutil, "which", lambda name: None)
    with pytest.raises(ImportError, match=r'the linker wasm-ld: pip install "arkanoid\[web\]"'):
        wasm.make_wasm(ENTRIES)
    monkeypatch.setattr(wasm.shutil, "which", lambda name: f"/usr/bin/{name}")
    assert wasm._find_linker() == ["/usr/bin/wasm-ld"]


def test_a_linker_that_fails_says_why() -> None:
    with pytest.raises(RuntimeError, match=r"could not be linked for browsers:\n(.|\n)*entries\.o"):
        wasm._link(wasm._find_linker(), b"no object file")
