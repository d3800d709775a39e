"""Links from pages to folders of the repository.

Sphinx copies a linked file into the site, but takes a link to a folder for a mistake.
"""

from pathlib import Path
from urllib.parse import urlsplit

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform
from sphinx.util.typing import ExtensionMetadata

ROOT = Path(__file__).resolve().parents[2]


class LinksToFolders(SphinxTransform):
    """Leads them to the repository's address, once the project has one."""

    default_priority = 100  # before MyST looks for a page of that name

    def apply(self, **_: object) -> None:
        """Change the links of one page."""
        for link in list(self.document.findall(addnodes.pending_xref)):
            if link.get("reftype") != "myst" or link.get("refdomain"):
                continue
            folder = Path(self.env.relfn2path(link["reftarget"], self.env.docname)[1]).resolve()
            if folder.is_dir() and folder.is_relative_to(ROOT):
                address = self.config.repository
                if urlsplit(address).hostname == "example.org":  # a placeholder: no link at all
                    link.replace_self(link.children)
                    continue
                address = f"{address}/tree/main/{folder.relative_to(ROOT).as_posix()}"
                link.replace_self(nodes.reference("", "", *link.children, refuri=address))


def setup(app: Sphinx) -> ExtensionMetadata:
    """Add the setting `repository`, an address without a slash at its end."""
    app.add_config_value("repository", "", "env", str)
    app.add_transform(LinksToFolders)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
