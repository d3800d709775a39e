"""The repository's files as pages of the site, for whatever the other pages link to.

A page links to a source file, an experiment or a folder by its relative path, as is right wherever
the repository is browsed. On the site such a link leads to `source/<path>.html`: a file's lines, or
a folder's files and what each of them is about. So do the links beside what the reference describes
(`linkcode`).
"""

import ast
import importlib
import inspect
import posixpath
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.transforms import SphinxTransform
from sphinx.util.typing import ExtensionMetadata

ROOT = Path(__file__).resolve().parents[2]
LANGUAGES = {".py": "python", ".toml": "toml", ".txt": "text", "": "text"}
KIND = "source"
Page = tuple[str, dict[str, Any], str]


class LinksToSources(SphinxTransform):
    """Marks the links to what lies in the repository and is no page of the site."""

    default_priority = 100  # before Sphinx copies what is to be downloaded

    def apply(self, **_: Any) -> None:
        """Change the links of one page; `resolve` gives them their address."""
        for kind in (addnodes.download_reference, addnodes.pending_xref):
            for link in list(self.document.findall(kind)):
                if link.get("reftype") != "myst" or link.get("refdomain"):
                    continue
                place = self.env.relfn2path(link["reftarget"], self.env.docname)[1]
                path = Path(place).resolve()
                if path.exists() and path.is_relative_to(ROOT):
                    linked(self.env).add(path)
                    address = {"refdoc": self.env.docname, "reftarget": page_name(path)}
                    mark = addnodes.pending_xref(refdomain="", reftype=KIND, **address)
                    mark += link.children
                    link.replace_self(mark)


def linked(env: BuildEnvironment) -> set[Path]:
    """Return the files and folders that pages link to, kept with what Sphinx knows of the pages."""
    paths: set[Path] = env.__dict__.setdefault("linked_sources", set())
    return paths


def page_name(path: Path) -> str:
    """Return the name of the page of a file or folder."""
    return posixpath.join("source", path.relative_to(ROOT).as_posix())


def resolve(
    app: Sphinx, _: BuildEnvironment, link: addnodes.pending_xref, text: nodes.Element
) -> nodes.reference | None:
    """Turn a marked link into one that leads to its page."""
    if link["reftype"] != KIND:
        return None
    address = app.builder.get_relative_uri(link["refdoc"], link["reftarget"])
    return nodes.reference("", "", text, refuri=address, internal=True)


def address_of(app: Sphinx, module: str, name: str) -> str | None:
    """Return where the code of what a page of the reference describes is."""
    described: Any = importlib.import_module(module or "arkanoid")
    for part in name.split("."):
        described = getattr(described, part, None)
    if isinstance(described, property):
        described = described.fget
    try:
        path = Path(inspect.getsourcefile(described) or "").resolve()
        line = inspect.getsourcelines(described)[1]
    except (TypeError, OSError):  # a constant, or what a class is given by others
        return None
    if not path.is_relative_to(ROOT):
        return None
    linked(app.env).add(path)
    return f"{app.builder.get_relative_uri(app.env.docname, page_name(path))}#line-{line}"


def pages(app: Sphinx) -> Iterator[Page]:
    """Yield a page for all that is linked to, and for what lies in a folder that is."""
    waiting, done = sorted(linked(app.env)), set[Path]()
    while waiting:
        path = waiting.pop()
        if path in done:
            continue
        done.add(path)
        title = path.relative_to(ROOT).as_posix()
        context = {"title": title, "furo_hide_toc": True}
        heading = f"<h1>{escape(title)}</h1>"
        if path.is_dir():
            held = sorted(filter(is_shown, path.iterdir()))
            waiting += held
            context["body"] = heading + listing(app, path, held)
        else:
            context["body"] = f'<div class="source-file">{heading}{highlighted(app, path)}</div>'
        yield page_name(path), context, "page.html"


def is_shown(path: Path) -> bool:
    """Tell whether a folder's page lists something: sources, and folders of sources."""
    if path.is_dir():
        return any(map(is_shown, path.iterdir()))
    return path.suffix in LANGUAGES and not path.name.startswith(".")


def highlighted(app: Sphinx, path: Path) -> str:
    """Return a file's lines as HTML."""
    highlighter = app.builder.highlighter  # type: ignore[attr-defined]
    text = path.read_text(encoding="utf-8")
    shown: str = highlighter.highlight_block(
        text, LANGUAGES.get(path.suffix, "text"), linenos="inline", lineanchors="line"
    )
    return shown


def listing(app: Sphinx, folder: Path, held: list[Path]) -> str:
    """Return a table of what a folder holds."""
    rows = []
    for path in held:
        address = app.builder.get_relative_uri(page_name(folder), page_name(path))
        name = escape(path.name + "/" * path.is_dir())
        rows.append(
            f'<tr><td><a href="{address}"><code>{name}</code></a></td>'
            f"<td>{escape(summary(path))}</td></tr>"
        )
    return f'<table class="docutils">{"".join(rows)}</table>'


def summary(path: Path) -> str:
    """Return the first line of a module's or package's docstring."""
    module = path / "__init__.py" if path.is_dir() else path
    if module.suffix != ".py" or not module.exists():
        return ""
    text = ast.get_docstring(ast.parse(module.read_bytes())) or ""
    return text.partition("\n\n")[0].replace("`", "")


def setup(app: Sphinx) -> ExtensionMetadata:
    """Have links and pages made, and `linkcode` told where code is."""
    app.add_transform(LinksToSources)
    app.connect("missing-reference", resolve)
    app.connect("html-collect-pages", pages)
    app.config.linkcode_resolve = lambda domain, info: address_of(
        app, info["module"], info["fullname"]
    )
    return {"parallel_read_safe": False}
