"""Docstrings and signatures as the reference shows them."""

import re
from typing import Any

import numpy as np
from docutils import nodes
from numpy.typing import ArrayLike, NDArray
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.util.typing import ExtensionMetadata, stringify_annotation

# Sphinx writes out what an alias stands for; a reader knows the alias.
ALIASES = {ArrayLike: "ArrayLike", NDArray[Any]: "NDArray[Any]"} | {
    NDArray[scalar]: f"NDArray[~numpy.{scalar.__name__}]"
    for scalar in (np.float64, np.int64, np.uint8, np.bool_)
}
SHORT = {stringify_annotation(alias, "smart"): name for alias, name in ALIASES.items()}


def shorten(
    _: Sphinx,
    kind: str,
    name: str,
    __: Any,
    options: Any,
    signature: str | None,
    result: str | None,
) -> tuple[str | None, str | None]:
    """Put the names of types in the place of what they stand for."""
    return abbreviated(signature), abbreviated(result)


def abbreviated(text: str | None) -> str | None:
    """Return a signature with short names of types."""
    for long, short in SHORT.items():
        text = text and text.replace(long, short)
    return text


def shorten_properties(_: Sphinx, page: nodes.document) -> None:
    """Do the same to the types of properties, which no event of autodoc tells of."""
    for annotation in list(page.findall(addnodes.desc_annotation)):
        text = annotation.astext()
        for long, short in SHORT.items():
            text = text.replace(without_modules(long), without_modules(short))
        if text != annotation.astext():
            annotation.children = [nodes.Text(text)]


def without_modules(text: str) -> str:
    """Return types as readers see them."""
    return re.sub(r"~[\w.]+\.", "", text)


def prepare(_: Sphinx, kind: str, name: str, __: Any, options: Any, lines: list[str]) -> None:
    """Change a docstring's lines in place, before Napoleon reads them."""
    # `Config`, wherever it is defined.
    lines[:] = [re.sub(r"(?<!`)`([A-Z]\w*)`(?!`)", r"`.\1`", line) for line in lines]
    if kind in ("property", "attribute") and lines:
        # What stands before a property's first colon is a type only in Napoleon's eyes.
        lines[0] = f": {lines[0]}"


def setup(app: Sphinx) -> ExtensionMetadata:
    """Listen to autodoc."""
    app.setup_extension("sphinx.ext.autodoc")
    app.connect("autodoc-process-signature", shorten)
    app.connect("autodoc-process-docstring", prepare, priority=400)
    app.connect("doctree-read", shorten_properties)
    return {"parallel_read_safe": True}
