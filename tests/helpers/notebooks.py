"""Runs a notebook's cells in order without Jupyter.

The cells become one program. Lines that begin with ``!`` become commands of the shell, and the
value at the end of a cell is shown as Jupyter would choose to: the program prints ``shown: png``.
"""

import ast
import json
import re
from pathlib import Path

# What a notebook imports of IPython.
DISPLAY = """
from pathlib import Path


class Image:
    def __init__(self, filename):
        self.data = Path(filename).read_bytes()

    def _repr_gif_(self):
        return self.data


class SVG:
    def __init__(self, data):
        self.data = data

    def _repr_svg_(self):
        return self.data
"""
BEGIN = """
import subprocess

SIGNATURES = {"png": b"\\x89PNG", "gif": b"GIF8", "svg": b"<svg"}


def system(command):
    subprocess.run(command, shell=True, check=True)


def show(value):
    for kind, signature in SIGNATURES.items():
        method = getattr(value, f"_repr_{kind}_", None)
        data = method() if method else None
        if data:
            data = data.encode() if isinstance(data, str) else data
            assert data.startswith(signature), (kind, data[:20])
            print("shown:", kind, flush=True)
"""


def cells(notebook: Path, kind: str) -> list[str]:
    """Return the texts of a notebook's cells of a kind, ``"code"`` or ``"markdown"``."""
    content = json.loads(notebook.read_text(encoding="utf-8"))
    return ["".join(cell["source"]) for cell in content["cells"] if cell["cell_type"] == kind]


def outputs(notebook: Path) -> list[object]:
    """Return what a notebook keeps of earlier runs."""
    content = json.loads(notebook.read_text(encoding="utf-8"))
    return [output for cell in content["cells"] for output in cell.get("outputs", ())]


def translated(cell: str) -> str:
    """Return the Python program of one cell."""
    python = re.sub(
        r"^!((?:.*\\\n)*.*)$", lambda found: f"system(f{found[1]!r})", cell, flags=re.MULTILINE
    )
    tree = ast.parse(python)
    last = tree.body[-1]
    if isinstance(last, ast.Expr):
        show = ast.Name("show", ast.Load())
        last.value = ast.Call(show, [last.value], [])
    return ast.unparse(ast.fix_missing_locations(tree))


def write_program(notebook: Path, folder: Path, **constants: int) -> Path:
    """Write a notebook as a program into a folder, with other values of some of its constants."""
    program = "\n".join([BEGIN, *map(translated, cells(notebook, "code"))])
    for name, value in constants.items():
        program, count = re.subn(rf"^{name} = \d+$", f"{name} = {value}", program, flags=re.M)
        assert count == 1, f"{notebook.name} sets {name} {count} times"
    display = folder / "IPython" / "display.py"
    display.parent.mkdir()
    display.write_text(DISPLAY, encoding="utf-8")
    script = folder / f"{notebook.stem}.py"
    script.write_text(program, encoding="utf-8")
    return script
