"""How Sphinx makes the site of the pages in `docs`: `make docs`."""

import sys
from pathlib import Path

import arkanoid

sys.path.insert(0, str(Path(__file__).parent))

project = "Arkanoid"
author = "the authors of Arkanoid"
project_copyright = ""
version = release = arkanoid.__version__

extensions = [
    "docstrings",
    "mathml",
    "myst_parser",
    "source_pages",
    "sphinx.ext.autodoc",
    "sphinx.ext.linkcode",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
]
exclude_patterns = ["site"]
nitpicky = True
# Without a network there are no pages of other projects to link to; and a docstring may name what
# is of interest in the sources only.
nitpick_ignore_regex = [
    ("py:.*", r"(collections|gymnasium|numpy|os|stable_baselines3)\..*"),
    ("py:class", r"ArrayLike|Batch|NDArray|arkanoid\..*"),
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
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_copyright = False
html_theme_options = {"top_of_page_buttons": []}
# Commands without their prompt; what a program prints is in blocks of text.
copybutton_prompt_text = "$ "
