"""The game on the site: the page that `arkanoid web` writes, and links to it.

The front page has one, and so have the figures of the engine's page: to the same scene.
"""

import re
from html import escape
from pathlib import Path
from typing import Any

from arkanoid.agents.commands.web import packaged_page
from sphinx.application import Sphinx
from sphinx.util.typing import ExtensionMetadata

FILE = "game.html"
LINK = f'<p class="play"><a href="{FILE}">Play it now</a> or watch agents, in your browser.</p>'

# The scene of each figure, as the page reads it from its address: of two bodies, and of many.
SCENES = {
    "colliders": "a=Rectangle,-2,0,1,0.3,2.4,1.4,29&b=Convex,2,0.4,-1,0",
    "open": "a=Convex,-1.5,-0.5,1,0,1,1,0,1,1,trapezium,2&b=Convex,2,0.5,0,0,1,1,0,0,1,trapezium,0",
    "minkowski": "a=Rectangle,-0.5,-0.45,0,0,2.1,1.3,29&b=Convex,0.5,0.35,0,0,1,1,0,1,1,triangle",
    "contacts": "a=Particle,-0.6,-0.4,0,0,1&b=Rectangle,0.45,0.3,0,0,1.8,1.1,326",
    "relaxation": "a=Particle,-0.35,-0.45,0,0,0.9,1,0,1&b=Particle,0.45,0.25,0,0,0.9,1,0,3",
    "bounce": "a=Particle,-0.65,-0.25,0.45,-0.6,0.8,1,0,2&b=Particle,0.65,0.1105,-0.85,0.3,0.55",
    "impacts": "a=Particle,-1.8,1.4,1,-0.68,0.5&b=AxisAlignedRectangle,0.9,-0.9,0,0,2,1.6,0,0",
    "disc_disc": "a=Particle,0,0,0,0,0.9&b=Particle,-3.1,1.75,1,-0.25,0.6",
    "disc_convex": "a=Particle,-3.1,2.6,1,-0.9,0.55&b=Convex,0,0,0,0,1.2,1,0,0,1,pentagon",
    "axes": "a=Rectangle,-0.9,-0.9,0,0,1.8,1.1,26&b=Convex,1.1,1,-0.8,-0.65,1,1,17,1,1,triangle",
}
WORLDS = {"world": "scene=world", "crowd": "scene=crowd"}
_FIGURE = re.compile(r'<p><img [^>]*/(\w+)\.svg"[^>]*/?></p>')


def link(app: Sphinx, page: str, _: str, context: dict[str, Any], *__: object) -> None:
    """Put the links below the heading of the front page, and below the engine's figures."""
    if page == "index":
        heading, end, rest = context["body"].partition("</h1>")
        context["body"] = f"{heading}{end}\n{LINK}{rest}"
    elif page == "engine":
        context["body"] = _FIGURE.sub(_with_scene, context["body"])


def _with_scene(figure: re.Match[str]) -> str:
    """Return a figure with the link to its scene, if it has one."""
    name = figure[1]
    if name in SCENES:
        scene = f"collide?{SCENES[name]}"
    elif name in WORLDS:
        scene = f"world?{WORLDS[name]}"
    else:
        return figure[0]
    address = escape(f"{FILE}#{scene}")
    return f'{figure[0]}\n<p class="scene"><a href="{address}">Try it yourself</a></p>'


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
