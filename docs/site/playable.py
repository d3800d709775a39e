"""The game on the site: the page that `arkanoid web` writes, and a link to it on the front page."""

from pathlib import Path
from typing import Any

from arkanoid.agents.commands.web import packaged_page
from sphinx.application import Sphinx
from sphinx.util.typing import ExtensionMetadata

FILE = "game.html"
LINK = f'<p class="play"><a href="{FILE}">Play it now</a> or watch agents, in your browser.</p>'


def link(app: Sphinx, page: str, _: str, context: dict[str, Any], *__: object) -> None:
    """Put the link below the heading of the front page."""
    if page == "index":
        heading, end, rest = context["body"].partition("</h1>")
        context["body"] = f"{heading}{end}\n{LINK}{rest}"


def write(app: Sphinx, error: Exception | None) -> None:
    """Write the page beside the others."""
    if error is None and app.builder.format == "html":
        Path(app.outdir, FILE).write_text(packaged_page(), encoding="utf-8")


def setup(app: Sphinx) -> ExtensionMetadata:
    """Add the page to the site."""
    app.connect("html-page-context", link)
    # Before `anchors` checks all links.
    app.connect("build-finished", write, priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
