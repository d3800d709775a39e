"""A page about an agent: one Markdown template, and what markdown-it makes of it as HTML.

Names of runs, levels and settings are other people's data: the templates escape every value, except
what functions here have made as `Markdown` or HTML.
"""

import base64
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

from jinja2 import Environment, PackageLoader, StrictUndefined
from markdown_it import MarkdownIt
from markupsafe import Markup

from ...envs.atomic import write_atomically
from ..experiment.files import printable

_KINDS = {".png": "image/png", ".gif": "image/gif"}
# What has a meaning inside a line of Markdown; underscores inside a word have none.
_SPECIAL = re.compile(r"[\\`*\[\]<>|&~$#]|(?<![A-Za-z0-9])_|_(?![A-Za-z0-9])")

# A picture's name -> the bytes of its file.
Pictures = Mapping[str, bytes]


class Markdown(str):
    """Text that is Markdown already."""


def write_page(path: Path, facts: Mapping[str, Any], pictures: Pictures) -> None:
    """Write a page as HTML with its pictures inside, or as Markdown with a folder of pictures.

    Args:
        path: of the page, ``.html`` or ``.md``; the folder beside it has its name without suffix.
        facts: what the template ``report.md.jinja`` shows.
        pictures: the files that it refers to.

    Raises:
        OSError: a file cannot be written.
    """
    if path.suffix.lower() == ".html":
        write_atomically(path, as_html(facts, pictures).encode())
        return
    folder = path.with_suffix("")
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in pictures.items():
        write_atomically(folder / name, content)
    sources = {name: f"{quote(folder.name)}/{quote(name)}" for name in pictures}
    write_atomically(path, as_markdown(facts, sources).encode())


def as_html(facts: Mapping[str, Any], pictures: Pictures) -> str:
    """Return the page as HTML that needs no other file."""
    sources = {name: _data_uri(name, content) for name, content in pictures.items()}
    # Without "html", tags inside Markdown are text.
    renderer = MarkdownIt("commonmark", {"html": False, "xhtmlOut": False}).enable("table")
    body = renderer.render(as_markdown(facts, sources))
    template = _templates(autoescape=True).get_template("page.html.jinja")
    return template.render(title=printable(f"Arkanoid: {facts['name']}"), body=Markup(body)) + "\n"


def as_markdown(facts: Mapping[str, Any], sources: Mapping[str, str]) -> str:
    """Return the page as Markdown; ``sources`` says where each picture lies."""

    def picture(name: str, text: str) -> Markdown:
        return Markdown(f"![{escape(text)}]({sources[name]})")

    template = _templates(finalize=escape).get_template("report.md.jinja")
    return template.render(facts, table=table, code=code, picture=picture) + "\n"


def escape(value: object) -> str:
    """Return a value as one line of Markdown that shows it as it is."""
    if isinstance(value, Markdown):
        return value
    return _SPECIAL.sub(lambda found: f"\\{found[0]}", printable(str(value)))


def table(rows: Sequence[Sequence[object]]) -> Markdown:
    """Return a table; the first row is its heading, and all columns but the first are numbers."""
    lines = [f"| {' | '.join(map(escape, row))} |" for row in rows]
    rule = f"| --- |{' ---: |' * (len(rows[0]) - 1)}"
    return Markdown("\n".join([lines[0], rule, *lines[1:]]))


def code(text: str) -> Markdown:
    """Return TOML in a fence that the text cannot close."""
    longest = max(map(len, re.findall("`+", text)), default=0)
    fence = "`" * max(3, longest + 1)
    return Markdown(f"{fence}toml\n{text.strip()}\n{fence}")


def _templates(**escaping: Any) -> Environment:
    return Environment(
        loader=PackageLoader(str(__package__), "."),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        **escaping,
    )


def _data_uri(name: str, content: bytes) -> str:
    return f"data:{_KINDS[Path(name).suffix]};base64,{base64.b64encode(content).decode()}"
