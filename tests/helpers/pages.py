"""Reads the pages of the documentation, the README's family included."""

import re
from functools import cache
from itertools import pairwise
from pathlib import Path

from markdown_it import MarkdownIt
from markdown_it.token import Token

from .repository import DOCS, ROOT

PAGES = sorted([*ROOT.glob("*.md"), *DOCS.rglob("*.md")])


def relative(path: Path) -> str:
    """Return a path from the root, as the names of tests have it."""
    return path.relative_to(ROOT).as_posix()


@cache
def tokens(page: Path) -> list[Token]:
    """Return what a page consists of, that within lines included."""
    parsed = MarkdownIt("commonmark").enable("table").parse(page.read_text(encoding="utf-8"))
    return [token for outer in parsed for token in (outer, *(outer.children or ()))]


def links(page: Path) -> list[tuple[str, str]]:
    """Return (path, anchor) of every link and picture of a page that leads to a file."""
    found = []
    for token in tokens(page):
        address = token.attrs.get("href") or token.attrs.get("src")
        if address and not re.match(r"[a-z]+:", str(address)):
            path, _, anchor = str(address).partition("#")
            found.append((path, anchor))
    return found


def anchors(page: Path) -> set[str]:
    """Return the anchors that GitHub gives a page's headings."""
    parts = pairwise(tokens(page))
    headings = [text.content for token, text in parts if token.type == "heading_open"]
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def commands(page: Path) -> list[str]:
    """Return the commands of a page's shell blocks, without the comments beside them."""
    lines = [
        line.partition("  #")[0].strip()
        for token in tokens(page)
        if token.type == "fence" and token.info == "sh"
        for line in token.content.splitlines()
    ]
    return [line for line in lines if line and not line.startswith("#")]


def program(page: Path) -> str:
    """Return a page's Python blocks as one program; each line keeps its number in the page."""
    lines: list[str] = []
    for token in tokens(page):
        if token.type == "fence" and token.info == "python":
            assert token.map is not None
            lines += [""] * (token.map[0] + 1 - len(lines)) + token.content.splitlines()
    return "\n".join([*lines, ""])
