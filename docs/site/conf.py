"""How Sphinx builds the site from the pages in `docs`: `make docs`."""

import sys
import tomllib
import types
from pathlib import Path
from typing import Generic, NewType, TypeVar

import numpy.typing

# Sphinx writes out what an alias stands for, on several lines for `ArrayLike`. These stand-ins keep
# their names in the reference.
Scalar = TypeVar("Scalar")
numpy.typing.ArrayLike = NewType("ArrayLike", object)
numpy.typing.NDArray = types.new_class("NDArray", (Generic[Scalar],))
for name in ("ArrayLike", "NDArray"):
    getattr(numpy.typing, name).__module__ = "numpy.typing"

import arkanoid  # noqa: E402
from sphinx.application import Sphinx  # noqa: E402

sys.path.insert(0, str(Path(__file__).parent))
PYPROJECT = Path(__file__).resolve().parents[2] / "pyproject.toml"

project = "Arkanoid"
author = "the authors of Arkanoid"
project_copyright = ""
version = release = arkanoid.__version__
repository = tomllib.loads(PYPROJECT.read_text("utf-8"))["project"]["urls"]["Repository"]

extensions = [
    "anchors",
    "folders",
    "mathml",
    "myst_parser",
    "playable",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
    "sphinx_copybutton",
]
exclude_patterns = ["site"]
nitpicky = True
# Without a network there are no pages of other projects to link to. And a docstring may name what
# only a reader of the sources needs.
nitpick_ignore_regex = [
    ("py:.*", r"(collections|gymnasium|numpy|os|stable_baselines3|torch|types)\..*"),
    ("py:class", r"Batch|VecEnv|arkanoid\..*"),
    ("py:obj", ".*"),
]

# Markdown as repository browsers know it: ```math, $x$, anchors of headings.
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4
myst_dmath_double_inline = True

autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
default_role = "py:obj"  # docstrings name things in single backticks
napoleon_google_docstring = True
napoleon_numpy_docstring = False

html_theme = "furo"
html_title = f"Arkanoid {version}"
html_math_renderer = "mathml"
html_favicon = "../pictures/icon.png"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_copyright = False
html_theme_options = {"top_of_page_buttons": []}
# Commands are copied without their prompt, and without what the program prints.
copybutton_prompt_text = "$ "


def keep_first_line(_: Sphinx, kind: str, *rest: object) -> None:
    """Keep what stands before the first colon of a property: Napoleon takes it for a type."""
    lines = rest[-1]
    if kind == "property" and isinstance(lines, list) and lines:
        lines[0] = f": {lines[0]}"


def setup(app: Sphinx) -> None:
    """Change docstrings before Napoleon reads them."""
    app.connect("autodoc-process-docstring", keep_first_line, priority=400)
