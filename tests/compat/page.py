"""Writes into docs/compatibility.md what came of the latest tries.

The table and the record are between marks; the rest of the page is written by hand.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from peers import HERE, ROOT, Peer, package, read_peers

PAGE = ROOT / "docs" / "compatibility.md"
RESULTS = HERE / "results.json"
MARK = "<!-- {} of `make compat` -->"
END = "<!-- end of it -->"


def read_results() -> dict[str, Any]:
    """Return the latest result of each peer that is still there."""
    if not RESULTS.exists():
        return {}
    results = json.loads(RESULTS.read_text(encoding="utf-8"))
    return {name: results[name] for name in read_peers() if name in results}


def write_page(page: Path = PAGE) -> None:
    """Put the table and the record of what was printed into the page."""
    text = page.read_text(encoding="utf-8")
    for part, lines in (("Table", table()), ("Record", record())):
        before, mark, rest = text.partition(MARK.format(part))
        _, end, after = rest.partition(END)
        if not mark or not end:
            raise ValueError(f"{page}: {MARK.format(part)} or its {END} is missing")
        text = "\n".join([before + mark, "", *lines, "", end + after])
    page.write_text(text, encoding="utf-8")


def table() -> Iterator[str]:
    """Yield the table's lines."""
    results = read_results()
    yield "| peer | `PEER=` | version | Gymnasium | what is tried | result |"
    yield "| --- | --- | --- | --- | --- | --- |"
    for peer in read_peers().values():
        result = results.get(peer.name)
        cells = [peer.title, f"`{peer.name}`", *versions(peer, result), peer.tried, outcome(result)]
        yield f"| {' | '.join(cells)} |"


def versions(peer: Peer, result: dict[str, Any] | None) -> tuple[str, str]:
    """Return the versions of the peer and of Gymnasium that were tried."""
    found = result["versions"] if result else {}
    first = package(peer.requirements[0])
    return found.get(first, "-"), found.get("gymnasium", "-")


def outcome(result: dict[str, Any] | None) -> str:
    """Return a word on a result."""
    if result is None:
        return "not yet tried"
    return "works" if result["passed"] else "**fails**"


def record() -> Iterator[str]:
    """Yield what was printed, one peer after the other."""
    yield "```text"
    for name, result in read_results().items():
        found = ", ".join(f"{key} {value}" for key, value in result["versions"].items())
        yield f"{name}: Python {result['python']} on {result['system']}"
        yield f"  {found}"
        yield from (f"  {line}" for line in result["printed"])
        yield ""
    yield "```"


if __name__ == "__main__":
    write_page()
