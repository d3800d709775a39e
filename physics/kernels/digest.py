"""The digest of all that a kernel's machine code is made from: its file, and what that imports.

Numba's own cache notices a change in the file that holds a function, but not in a file that holds
a function it *calls*, and then runs stale machine code. Here the digest covers the file and every
file of this package that it imports, directly or not: to be stale, a kernel would have to call
something that it cannot name. A constant that a kernel reads must therefore be written in source,
not computed from the contents of some other file.

A process runs the sources that it imported, which may have been edited since. It reads each file
once, while it imports the kernels, and afterwards only compares the file's time and size with those
it had then. So no clock matters: a file may be dated in the future.
"""

import hashlib
import os
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

PACKAGE = __name__.rpartition(".physics.")[0]
_PACKAGE_FOLDER = str(Path(__file__).resolve().parents[2])


# These decide where machine code is kept and what the user is told, not what the machine code is.
_WITHOUT_INFLUENCE = frozenset(
    str(Path(__file__).resolve().with_name(name))
    for name in ("cache.py", "code_files.py", "messages.py", "sealed.py")
)

# Import statements, found without a parser, which would take most of a warm start. The patterns
# also find what looks like one in a text or comment, inside of another one too: a file too many in
# a digest does no harm. They miss none.
_SPACE = r"(?:[ \t\f]|\\\n)"
_NAMES = rf"""(?:
    {_SPACE}*\( (?P<bracketed> (?: [^()#] | \#[^\n]*\n )* )
    | (?P<open> (?: [^\n;#\\] | \\\n )* )
)"""
_FROM = re.compile(
    rf"\bfrom\b (?= (?P<module> (?: [\w.] | {_SPACE} )*? ) \bimport\b {_NAMES} )", re.VERBOSE
)
_IMPORT = re.compile(rf"\bimport\b (?= {_NAMES} )", re.VERBOSE)
_COMMENT = re.compile(r"#[^\n]*")


@cache
def digest(file: Path, compiler: str) -> str:
    """Return 16 hexadecimal digits for a source file, what it imports, and the compiler's state."""
    result = hashlib.sha256(compiler.encode())
    for source in sorted(_import_closure(str(file))):
        result.update(_read(source).digest)
    return result.hexdigest()[:16]


def is_edited(file: Path) -> bool:
    """Return whether the file, or one that it imports, changed after this process read it."""
    return any(_stamp(source) != _read(source).stamp for source in _import_closure(str(file)))


@cache
def _import_closure(file: str) -> frozenset[str]:
    """Return the file and all files of the package that it imports, directly or not."""
    found = {file}
    frontier = [file]
    while frontier:
        new = _read(frontier.pop()).imports - found
        found |= new
        frontier += new
    return frozenset(found)


class _Source(NamedTuple):
    """A source file when this process first read it."""

    stamp: tuple[int, int] | None
    digest: bytes
    imports: frozenset[str]


@cache
def _read(file: str) -> _Source:
    stamp = _stamp(file)
    content = Path(file).read_bytes()
    return _Source(stamp, hashlib.sha256(content).digest(), _imported_files(file, content))


def _stamp(file: str) -> tuple[int, int] | None:
    """Return a file's time in nanoseconds and its size in bytes, None if it is gone."""
    try:
        status = os.stat(file)
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size


def _imported_files(file: str, content: bytes) -> frozenset[str]:
    """Return the files of the package that one file names in its import statements."""
    text = content.decode("utf-8", "replace").replace("\r\n", "\n").replace("\r", "\n")
    found = set()
    for folder, dotted in _imported_names(text, file):
        path = os.path.join(folder, *dotted.split(".")) if dotted else folder
        found |= {f"{path}.py", os.path.join(path, "__init__.py")}
    return frozenset(path for path in found - _WITHOUT_INFLUENCE if os.path.isfile(path))


def _imported_names(text: str, file: str) -> Iterator[tuple[str, str]]:
    """Yield what the import statements of a source may name: a folder, and dotted names below it.

    Inside the package every import is relative; kernels outside of it name the package.
    """
    for found in _FROM.finditer(text):
        module = re.sub(r"[\s\\]", "", found["module"])
        dotted = module.lstrip(".")
        if dotted == module:
            top, _, dotted = module.partition(".")
            if top != PACKAGE:
                continue
            folder = _PACKAGE_FOLDER
        else:
            folder = file
            for _ in range(len(module) - len(dotted)):
                folder = os.path.dirname(folder)
        yield folder, dotted
        # `from . import x` and `from .package import x` may name modules, too.
        for name in _names(found):
            yield folder, f"{dotted}.{name}".strip(".")
    for found in _IMPORT.finditer(text):
        for name in _names(found):
            top, _, dotted = name.partition(".")
            if top == PACKAGE:
                yield _PACKAGE_FOLDER, dotted


def _names(found: re.Match[str]) -> list[str]:
    """Return the names, perhaps dotted, behind an `import`; what they are called here, too."""
    text = _COMMENT.sub("", found["bracketed"] or found["open"] or "")
    return re.findall(r"\w[\w.]*", re.sub(rf"{_SPACE}*\.{_SPACE}*", ".", text))
