"""Follows every link within the site that was built: `python docs/site/check_links.py build/docs`.

Sphinx knows of the links between its own pages only, not of those to the pages of the sources.
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """What a page has: names to be linked to, and addresses that it needs."""

    def __init__(self, file: Path) -> None:
        super().__init__()
        self.file = file
        self.names = {"", "top"}
        self.addresses: set[str] = set()
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Keep what a tag names and links to."""
        for name, value in attrs:
            if name in ("id", "name") and value:
                self.names.add(value)
            elif name in ("href", "src") and value:
                self.addresses.add(value)


def broken(site: Path) -> list[str]:
    """Return the links that lead nowhere, each with its page."""
    pages = {file.resolve(): Page(file.resolve()) for file in site.rglob("*.html")}
    found = []
    for file, page in pages.items():
        for address in sorted(page.addresses):
            parts = urlsplit(address)
            if parts.scheme or parts.netloc:
                continue
            target = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            anchored = target in pages and unquote(parts.fragment) in pages[target].names
            if not target.exists() or (target in pages and not anchored):
                found.append(f"{file.relative_to(site.resolve())}: {address}")
    return found


if __name__ == "__main__":
    lost = broken(Path(sys.argv[1]))
    print("\n".join(lost) or "every link within the site leads somewhere")
    sys.exit(bool(lost))
