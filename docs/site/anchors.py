"""Links within the built site lead somewhere, those in the pages of the sources, too."""

import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from playable import FILE as GAME
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.typing import ExtensionMetadata

# The link from a source back to its description, as `sphinx.ext.viewcode` writes it.
BACK = re.compile(r'(id="([\w.]+)">\s*<a class="viewcode-back" href="[^"#]*#)([\w.]+)')


class Page(HTMLParser):
    """The links of a page, and the places in it that have a name."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.names: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what a tag links to, and its name."""
        for key, value in attrs:
            if key in ("href", "src") and value:
                self.links.append(value)
            elif key in ("id", "name") and value:
                self.names.add(value)


def lead_back(app: Sphinx, page: str, _: str, context: dict[str, Any], *__: object) -> None:
    """Lead sources back to the name under which each object is described.

    Viewcode takes all objects of a module for described in one place. But the reference has those
    that a package exports under the package's name, and the others under their module's.
    """
    if not page.startswith("_modules/") or page == "_modules/index":
        return
    described = app.env.domains.python_domain.objects

    def right(found: re.Match[str]) -> str:
        link, name, target = found.groups()
        return link + (target if target in described else f"{context['title']}.{name}")

    context["body"] = BACK.sub(right, context["body"])


def check(app: Sphinx, error: Exception | None) -> None:
    """Warn of links that lead nowhere; `make docs` takes a warning for an error."""
    if error is not None or app.builder.format != "html":
        return
    root = Path(app.outdir).resolve()
    # The game's own links have no names in it: its program reads them.
    paths = sorted(set(root.rglob("*.html")) - {root / GAME})
    pages = {path: Page(path) for path in paths}
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            names = pages[target].names if target in pages else None
            lost = parts.fragment and names is not None and unquote(parts.fragment) not in names
            if lost or not target.exists():
                where = path.relative_to(root).as_posix()
                logging.getLogger(__name__).warning("%s: nothing at %s", where, link)


def setup(app: Sphinx) -> ExtensionMetadata:
    """Mend the links of each page, and check all of them at the end."""
    app.connect("html-page-context", lead_back)
    app.connect("build-finished", check)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
