"""Entries for graphics cards: what their PTX consists of, that it assembles, and how it is kept."""

import hashlib
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from arkanoid.envs.tensors.entries import STEPS
from arkanoid.physics.kernels import sealed
from arkanoid.physics.kernels.portable import Entry, kept, ptx

ENTRIES = [run.entry for run in STEPS["vector"]]
# The others take minutes; their games are the same.
KINDS = ["vector", *(pytest.param(k, marks=pytest.mark.slow) for k in STEPS if k != "vector")]
MOST_STACK = 4096  # bytes of a thread: a card reserves as much for each that it could run at once
CARDS = ("sm_80", "sm_90", "sm_100")


@pytest.fixture(scope="module", params=KINDS)
def kind(request: pytest.FixtureRequest) -> str:
    """Return a kind of observation."""
    return str(request.param)


@pytest.fixture(scope="module")
def code(kind: str) -> str:
    """Return the PTX of the entries that step worlds seen so; it is made or was kept."""
    return ptx.make_ptx([run.entry for run in STEPS[kind]])


def assembler() -> str:
    """Return NVIDIA's assembler: on the path, or in the wheel nvidia-cuda-nvcc."""
    found = shutil.which("ptxas")
    spec = find_spec("nvidia")
    for folder in (spec.submodule_search_locations or ()) if found is None and spec else ():
        found = next((str(path) for path in Path(folder).glob("*/bin/ptxas*")), found)
    if found is None and sys.platform != "linux":
        pytest.skip("there is no ptxas for this system")
    assert found is not None, "no ptxas here: the extra dev brings it (nvidia-cuda-nvcc)"
    return found


def test_each_entry_is_a_kernel_of_a_count_and_an_address(kind: str, code: str) -> None:
    kernels = re.findall(r"\.visible \.entry (\w+)\(\s*([^)]*)\)", code)
    names = [f"{run.entry.name}_kernel" for run in STEPS[kind]]
    assert sorted(name for name, _ in kernels) == sorted(names)
    for _, parameters in kernels:
        assert parameters.count(".param .u64") + parameters.count(".param .b64") == 2, parameters


def test_nothing_rounds_otherwise_than_on_this_processor(code: str) -> None:
    """A joined multiplication and addition would round once; so would an approximate root."""
    lines = re.sub(r"//.*", "", code)
    words = set(re.findall(r"^\s*(?:@\S+\s+)?([a-z]\w*(?:\.\w+)+)", lines, re.MULTILINE))
    floating = {word for word in words if word.endswith((".f64", ".f32"))}
    assert {"mul.rn.f64", "add.rn.f64", "div.rn.f64", "sqrt.rn.f64"} <= floating
    assert not {word for word in floating if re.match(r"(fma|mad)\.", word)}
    assert not {word for word in floating if ".approx" in word or ".ftz" in word}
    # Each that rounds says how: ptxas joins those that do not.
    rounds = {word for word in floating if re.match(r"(mul|add|sub|div|sqrt)\.", word)}
    assert all(".rn." in word for word in rounds), rounds


def test_nothing_is_missing(code: str) -> None:
    assert re.findall(r"^\.extern .*$", code, re.MULTILINE) == []


def said_of(kind: str, code: str, card: str, folder: Path) -> str:
    """Return what the assembler says; fail if it refuses the code.

    It is kept with the code, for that assembler and that code only: it takes 20 seconds.
    """
    program = assembler()
    # Quickly: what it optimises, it checks all the same.
    options = ["-O1", "-arch", card, "-v"]

    def assemble() -> bytes:
        source = folder / "entries.ptx"
        source.write_text(code)
        command = [program, *options, "-o", folder / "cubin", source]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stderr.encode()

    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True)
    asked = hashlib.sha256(f"{version.stdout} {options} {code}".encode()).hexdigest()[:16]
    product = kept.Product(f"said-{asked}", card, b"ARKASAID", 1, ())
    return kept.make_once(product, [run.entry for run in STEPS[kind]], assemble).decode()


@pytest.mark.parametrize("card", CARDS)
def test_it_assembles_with_a_small_stack(kind: str, code: str, card: str, tmp_path: Path) -> None:
    said = said_of(kind, code, card, tmp_path)
    stacks = [int(size) for size in re.findall(r"(\d+) bytes stack frame", said)]
    assert len(stacks) >= len(STEPS[kind])
    assert max(stacks) <= MOST_STACK
    assert "recurs" not in said.lower(), "the size of its stack can't be known"


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[int]:
    """Let PTX be made at once, into a cache of its own; return a list that grows each time."""
    made: list[int] = []

    def assemble(code: str, entries: object) -> str:
        made.append(len(made))
        return f"text {len(made)}"

    monkeypatch.setenv("ARKANOID_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(ptx, "compile_entries", lambda entries: "")
    monkeypatch.setattr(ptx, "_assemble", assemble)
    return made


def kept_file(folder: Path) -> Path:
    (file,) = folder.rglob("entries.ptx")
    return file


def test_it_is_made_once(quick: list[int]) -> None:
    assert [ptx.make_ptx(ENTRIES) for _ in range(3)] == ["text 1"] * 3
    assert ptx.make_ptx(ENTRIES[:1]) == "text 2"


@pytest.mark.parametrize("damage", [b"", b"ARKAPTX\0nonsense", None])
def test_a_damaged_file_is_replaced(quick: list[int], tmp_path: Path, damage: bytes | None) -> None:
    ptx.make_ptx(ENTRIES)
    file = kept_file(tmp_path)
    file.write_bytes(file.read_bytes()[:-1] + b"?" if damage is None else damage)
    assert ptx.make_ptx(ENTRIES) == "text 2" == ptx.make_ptx(ENTRIES)


def test_where_nothing_can_be_written_it_is_made_again(
    quick: list[int], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A full disk ended in an OSError."""

    def refuse(source: object, target: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(sealed.os, "replace", refuse)
    assert [ptx.make_ptx(ENTRIES) for _ in range(2)] == ["text 1", "text 2"]
    assert "No space left on device" in capsys.readouterr().err


def test_other_makers_make_it_again(quick: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """A kept file stayed when only the code that makes PTX had changed."""
    ptx.make_ptx(ENTRIES)
    monkeypatch.setattr(kept, "digest", lambda file, compiler: f"another {file.name}")
    assert ptx.make_ptx(ENTRIES) == "text 2"


def test_a_failure_says_why() -> None:
    entry = Entry("arkanoid.physics.kernels.portable.addresses", "nothing")
    with pytest.raises(RuntimeError, match=r"could not be compiled afresh:\n(.|\n)*nothing"):
        ptx.compile_entries([entry])
