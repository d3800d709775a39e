"""A page of text, tables and pictures, as HTML that needs no other file, or as Markdown."""

import base64
import html
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Heading:
    """A heading; level 1 is the page's title."""

    text: str
    level: int = 2


@dataclass(frozen=True)
class Text:
    """A paragraph."""

    text: str


@dataclass(frozen=True)
class Code:
    """Text that is shown as it is."""

    text: str


@dataclass(frozen=True)
class Table:
    """Rows of text; the first one is the heading."""

    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Picture:
    """A picture file's bytes; its name's ending says of which kind it is."""

    name: str
    content: bytes
    text: str


Part = Heading | Text | Code | Table | Picture

_KINDS = {".png": "image/png", ".gif": "image/gif"}
_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 70rem; margin: 2rem auto; padding: 0 1rem }
table { border-collapse: collapse; display: block; overflow-x: auto }
th, td { padding: .2rem .6rem; text-align: right; border-bottom: 1px solid #ccc }
th:first-child, td:first-child { text-align: left }
pre { background: #f4f4f4; padding: 1rem; overflow-x: auto }
img { max-width: 100% }
"""


def as_html(parts: Sequence[Part]) -> str:
    """Return a page that holds all that it shows."""
    title = next((part.text for part in parts if isinstance(part, Heading)), "Report")
    body = "\n".join(map(_html, parts))
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<meta charset="utf-8">\n'
        f"<title>{html.escape(title)}</title>\n<style>{_STYLE}</style>\n{body}\n</html>\n"
    )


def _html(part: Part) -> str:
    if isinstance(part, Heading):
        return f"<h{part.level}>{html.escape(part.text)}</h{part.level}>"
    if isinstance(part, Text):
        return f"<p>{html.escape(part.text)}</p>"
    if isinstance(part, Code):
        return f"<pre>{html.escape(part.text)}</pre>"
    if isinstance(part, Picture):
        data = base64.b64encode(part.content).decode()
        kind = _KINDS[Path(part.name).suffix]
        return f'<img src="data:{kind};base64,{data}" alt="{html.escape(part.text)}">'
    rows = [
        "<tr>" + "".join(f"<{cell}>{html.escape(text)}</{cell}>" for text in row) + "</tr>"
        for cell, row in zip(["th"] + ["td"] * len(part.rows), part.rows, strict=False)
    ]
    return "<table>\n" + "\n".join(rows) + "\n</table>"


def as_markdown(parts: Sequence[Part], path: Path) -> str:
    """Return the text of a page at ``path``; its pictures are written into a folder beside it."""
    folder = path.with_suffix("")
    pictures = [part for part in parts if isinstance(part, Picture)]
    if pictures:
        folder.mkdir(parents=True, exist_ok=True)
    for picture in pictures:
        (folder / picture.name).write_bytes(picture.content)
    return "\n\n".join(_markdown(part, folder.name) for part in parts) + "\n"


def _markdown(part: Part, folder: str) -> str:
    if isinstance(part, Heading):
        return f"{'#' * part.level} {part.text}"
    if isinstance(part, Text):
        return part.text
    if isinstance(part, Code):
        return f"```toml\n{part.text.strip()}\n```"
    if isinstance(part, Picture):
        return f"![{part.text}]({folder}/{part.name})"
    head, *rows = [f"| {' | '.join(row)} |" for row in part.rows]
    line = f"| --- |{' ---: |' * (len(part.rows[0]) - 1)}"
    return "\n".join([head, line, *rows])
