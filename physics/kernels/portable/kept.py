"""What is made of entries for other machines: kept with the machine code of other kernels."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import llvmlite
import numba

from ..cache import writable_folder
from ..digest import digest
from ..messages import say_compiling_for, say_unwritable
from ..sealed import unseal, write_sealed
from .entries import Entry


class Product(NamedTuple):
    """A kind of code that is made of entries.

    Attributes:
        name: of it; its file is ``entries.NAME``.
        machines: what it is for, in words.
        mark: eight bytes with which its files begin.
        version: of their format.
        makers: the files beside this one that make it. Entries don't import them.
    """

    name: str
    machines: str
    mark: bytes
    version: int
    makers: tuple[str, ...]


def make_once(product: Product, entries: Sequence[Entry], make: Callable[[], bytes]) -> bytes:
    """Return what `make` returns, or has returned before: as long as no source changes.

    Args:
        entries: all of one file.
    """
    versions = f"{numba.__version__} {llvmlite.__version__}"
    folder = writable_folder(_file(entries), f"{_makers(product, entries)} {versions}")
    kept = None if folder is None else folder / f"entries.{product.name}"
    made = None if kept is None else _load(kept, product)
    if made is None:
        say_compiling_for(product.machines)
        made = make()
        if kept is not None:
            _save(kept, product, made)
    return made


def sources_of(product: Product, entries: Sequence[Entry]) -> str:
    """Return a digest, of 16 letters, of all sources that are needed to make it.

    Args:
        entries: all of one file.
    """
    return digest(_file(entries), _makers(product, entries))


def _makers(product: Product, entries: Sequence[Entry]) -> str:
    """Return what is made, and the digests of the files that make it."""
    digests = [digest(Path(__file__).with_name(name), "") for name in product.makers]
    return f"{product.name} {digests} {entries!r}"


def _file(entries: Sequence[Entry]) -> Path:
    """Return the file of entries, whose digest covers what it imports."""
    (file,) = {entry.file for entry in entries}
    return file


def _load(kept: Path, product: Product) -> bytes | None:
    """Return the content of a file; None if it can't be read. A damaged file is deleted."""
    with suppress(OSError):
        try:
            what = f"file of {product.name}"
            return bytes(unseal(what, product.mark, product.version, kept.read_bytes()))
        except ValueError:
            kept.unlink()
    return None


def _save(kept: Path, product: Product, made: bytes) -> None:
    """Keep it in a file, or go on without."""
    try:
        write_sealed(kept, product.mark, product.version, made)
    except OSError as error:
        say_unwritable(kept.parents[1], error)
