"""The module that comes with the package: it is used if it was made of these sources."""

from pathlib import Path

import pytest
from arkanoid.envs.browser import shipped
from arkanoid.physics.kernels.portable import wasm


@pytest.fixture
def file(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Return where a module would be shipped; one that is made here is ``b"made"``."""
    monkeypatch.setattr(shipped, "FILE", tmp_path / "module.sealed")
    monkeypatch.setattr(shipped, "make_wasm", lambda entries: b"made")
    return tmp_path / "module.sealed"


def test_without_one_it_is_made(file: Path) -> None:
    assert shipped.game_module() == b"made"


def test_a_shipped_one_is_used(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shipped.ship_module()
    monkeypatch.setattr(shipped, "make_wasm", lambda entries: b"made anew")
    assert shipped.game_module() == b"made"


def test_one_of_other_sources_is_not_used(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shipped.ship_module()
    monkeypatch.setattr(shipped, "wasm_sources", lambda entries: "f" * 16)
    monkeypatch.setattr(shipped, "make_wasm", lambda entries: b"made anew")
    assert shipped.game_module() == b"made anew"


@pytest.mark.parametrize("content", [b"", b"nonsense", None])
def test_a_damaged_one_is_not_used(
    file: Path, monkeypatch: pytest.MonkeyPatch, content: bytes | None
) -> None:
    shipped.ship_module()
    file.write_bytes(file.read_bytes()[:-1] + b"?" if content is None else content)
    monkeypatch.setattr(shipped, "make_wasm", lambda entries: b"made anew")
    assert shipped.game_module() == b"made anew"


def test_the_digest_says_of_which_sources() -> None:
    assert len(shipped.wasm_sources(shipped.ENTRIES)) == 16
    assert shipped.wasm_sources(shipped.ENTRIES[:1]) != shipped.wasm_sources(shipped.ENTRIES)


def test_pages_are_offered_where_the_module_is_or_can_be_made(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After `make train`, the printed command ended with a missing linker."""
    monkeypatch.setattr(shipped, "has_linker", lambda: False)
    assert not shipped.offers_module()
    shipped.ship_module()
    assert shipped.offers_module()
    file.unlink()
    monkeypatch.setattr(shipped, "has_linker", lambda: True)
    assert shipped.offers_module()


def test_a_linker_that_is_missing_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    assert wasm.has_linker()
    monkeypatch.setattr(wasm, "find_spec", lambda name: None)
    monkeypatch.setattr(wasm.shutil, "which", lambda name: None)
    assert not wasm.has_linker()
