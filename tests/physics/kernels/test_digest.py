"""The digest: after any edit, nothing runs stale machine code."""

import ast
import os
import time
from pathlib import Path

import pytest
from arkanoid.physics.kernels import digest
from helpers.repository import ROOT
from helpers.scratch_package import Scratch


def test_caller_sees_an_edited_callee(scratch: Scratch) -> None:
    """Numba's own cache looks only at the caller's file, and kept running the old callee."""
    assert scratch.run().result == 21.0
    scratch.replace("arkanoid/physics/callee.py", "x * FACTOR", "x * FACTOR + 100.0")
    assert scratch.run().result == 121.0


def test_caller_sees_an_edited_constant(scratch: Scratch) -> None:
    """The constant is two files away. Its value is a part of the machine code."""
    assert scratch.run().result == 21.0
    scratch.replace("arkanoid/physics/numbers.py", "2.0", "3.0")
    assert scratch.run().result == 31.0


def test_caller_outside_the_package_sees_an_edited_callee(scratch: Scratch) -> None:
    call = "from user import shifted; report(shifted(10.0))"
    assert scratch.run(call).result == 21.0
    assert scratch.run(call).compiled == []
    scratch.replace("arkanoid/physics/numbers.py", "2.0", "3.0")
    assert scratch.run(call).result == 31.0


@pytest.mark.parametrize(
    ("statement", "call"),
    [
        ("from .. import physics", "physics.extra.FACTOR"),
        ("from ..physics import extra", "extra.FACTOR"),
        ("from ..physics import extra as other", "other.FACTOR"),
        ("from ..physics import (  # one (of two)\n    extra,\n)", "extra.FACTOR"),
    ],
)
def test_every_form_of_import_is_followed(scratch: Scratch, statement: str, call: str) -> None:
    scratch.write("arkanoid/physics/__init__.py", "from . import extra\n")
    scratch.write("arkanoid/physics/extra.py", "FACTOR = 5.0\n")
    scratch.replace("arkanoid/envs/caller.py", "from ..physics.callee", f"{statement}\n#")
    scratch.replace("arkanoid/envs/caller.py", "scaled(x)", f"x * {call}")
    assert scratch.run().result == 51.0
    scratch.replace("arkanoid/physics/extra.py", "5.0", "6.0")
    assert scratch.run().result == 61.0


def test_edit_during_a_start_is_not_lost(scratch: Scratch) -> None:
    """A source was saved after a process had imported it, and before its digest was computed.

    The old machine code was then in the new digest's folder, and every later process ran it.
    """
    during = scratch.run("""
import pathlib, time
from arkanoid.physics import callee
time.sleep(0.1)  # the clock of files is coarse
file = pathlib.Path(callee.__file__)
file.write_text(file.read_text().replace("x * FACTOR", "x * FACTOR + 100.0"))
from arkanoid.envs.caller import shifted
report(shifted(10.0))
""")
    assert during.result == 21.0
    assert scratch.run().result == 121.0


def test_reload_of_an_edited_source_is_not_lost(scratch: Scratch) -> None:
    """A reloaded module's kernels ran the machine code of the module as it was before the edit."""
    scratch.run()
    during = scratch.run("""
import importlib, pathlib
from arkanoid.physics import callee, numbers
file = pathlib.Path(numbers.__file__)
file.write_text("FACTOR = 30.0")
importlib.reload(numbers)
report(importlib.reload(callee).scaled(10.0))
""")
    assert during.result == 300.0
    assert scratch.run().result == 301.0


def test_a_source_may_be_dated_in_the_future(scratch: Scratch) -> None:
    """Where a clock had been set back, every process compiled again, without a word."""
    tomorrow = time.time() + 86_400
    for file in scratch.code.rglob("*.py"):
        os.utime(file, (tomorrow, tomorrow))
    assert scratch.run().compiled != []
    assert scratch.run().compiled == []


@pytest.mark.parametrize("name", ["cache", "code_files", "messages", "sealed"])
def test_edit_of_what_has_no_influence_recompiles_nothing(scratch: Scratch, name: str) -> None:
    """A new wording of a message made every user wait for the compiler."""
    scratch.run()
    scratch.replace(
        f"arkanoid/physics/kernels/{name}.py", '"""\n\nimport', '"""\n\n# edited\nimport'
    )
    assert scratch.run().compiled == []


def test_edit_recompiles_only_what_can_depend_on_it(scratch: Scratch) -> None:
    call = "from arkanoid.physics.callee import scaled; report(scaled(10.0))"
    scratch.run()
    scratch.run(call)
    scratch.replace("arkanoid/envs/caller.py", "1.0", "2.0")
    assert scratch.run(call).compiled == []
    # A kernel is compiled together with what it calls.
    assert scratch.run().compiled == ["shifted", "scaled"]


def test_debugging_does_not_run_code_without_checks(scratch: Scratch) -> None:
    """Bounds checks found nothing: the machine code came from the cache, without checks."""
    scratch.run()
    assert scratch.run(NUMBA_BOUNDSCHECK="1").compiled != []
    assert scratch.run().compiled == []


# Statements that are hard to find without a parser.
HARD = [
    "from.a import b",
    "from . . a import b",
    "from . import(a,b)",
    "from .a import\\\n    b",
    "from .a \\\n import b as \\\n c, d",
    "from . import (a,  # not (c)\n  b, # from . import d\n  c\n)",
    "x = 1; from . import a; y = 2",
    "if True: from .a import b; from .c import d",
    "try: from . import a\nexcept ImportError: from . import b",
    "def f():\n\tfrom ..a.b import c # d",
    "'from'; from . import a",
    "'from . import (see below'\nfrom . import a\nfrom .b import c",
    "# from . import (\nfrom . import a",
    "import arkanoid.a, numpy as np, arkanoid.b.c as c",
    "import arkanoid . a \\\n . b as c; import arkanoid",
    "import arkanoid.a as arkanoid; from arkanoid.b import c",
    "from arkanoid import a",
    "from . import a\r\nfrom . import b\rfrom . import c",
    "from .a import *",
]


def parsed(text: str, file: Path) -> set[tuple[str, str]]:
    """What the import statements of a source name, as Python's own parser finds them."""
    found = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom):
            names = [alias.name for alias in node.names if alias.name != "*"]
            folder, dotted = str(file.parents[max(0, node.level - 1)]), node.module or ""
            if not node.level:
                top, _, dotted = dotted.partition(".")
                if top != "arkanoid":
                    continue
                folder = digest._PACKAGE_FOLDER
            found |= {(folder, f"{dotted}.{name}".strip(".")) for name in ["", *names]}
        elif isinstance(node, ast.Import):
            for alias in node.names:
                top, _, dotted = alias.name.partition(".")
                if top == "arkanoid":
                    found.add((digest._PACKAGE_FOLDER, dotted))
    return found


@pytest.mark.parametrize("text", HARD)
def test_no_import_is_missed(text: str) -> None:
    """Against Python's parser; a name too many does no harm."""
    file = ROOT / "envs" / "game" / "here.py"
    expected = parsed(text, file)
    assert expected
    lines = text.replace("\r\n", "\n").replace("\r", "\n")
    assert expected <= set(digest._imported_names(lines, str(file)))


def test_no_import_of_the_package_is_missed() -> None:
    for package in ("physics", "envs", "agents"):
        for file in (ROOT / package).rglob("*.py"):
            text = file.read_text(encoding="utf-8")
            assert parsed(text, file) <= set(digest._imported_names(text, str(file))), file
