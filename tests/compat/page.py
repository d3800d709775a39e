"""Writes the results of the latest runs into the documentation: `python -m compat.page` in tests/.

The table goes into docs/compatibility.md, between two marks. What the commands printed goes into a
file of its own, docs/results/compatibility.txt.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .peers import HERE, ROOT, Peer, package, read_peers

PAGE = ROOT / "docs" / "compatibility.md"
PRINTED = ROOT / "docs" / "results" / "compatibility.txt"
RESULTS = HERE / "results.json"
MARK = "<!-- Table of `make compat` -->"
END = "<!-- End of the table -->"


def read_results() -> dict[str, Any]:
    """Return the latest result of each peer in `peers.toml`."""
    if not RESULTS.exists():
        return {}
    results = json.loads(RESULTS.read_text(encoding="utf-8"))
    return {name: results[name] for name in read_peers() if name in results}


def write_page(page: Path = PAGE, printed: Path = PRINTED) -> None:
    """Write the table into the page, and what the commands printed into its file."""
    before, mark, rest = page.read_text(encoding="utf-8").partition(MARK)
    _, end, after = rest.partition(END)
    if not mark or not end:
        raise ValueError(f"{page}: {MARK} or {END} is missing")
    text = "\n".join([before + mark, "", *table(), "", end + after])
    page.write_text(text, encoding="utf-8")
    printed.write_text("\n".join(output()), encoding="utf-8")


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
    first = next(iter([*peer.commits(), *map(package, (*peer.alone, *peer.requirements))]))
    return found.get(first, "-"), found.get("gymnasium", "-")


def outcome(result: dict[str, Any] | None) -> str:
    """Return a word on a result."""
    if result is None:
        return "not yet tried"
    return "works" if result["passed"] else "**fails**"


def output() -> Iterator[str]:
    """Yield the lines that the commands printed, peer by peer."""
    for name, result in read_results().items():
        found = ", ".join(f"{key} {value}" for key, value in result["versions"].items())
        yield f"{name}: Python {result['python']} on {result['system']}"
        yield f"  {found}"
        yield from (f"  {line}" for line in result["printed"])
        yield ""


if __name__ == "__main__":
    write_page()
