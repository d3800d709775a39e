"""The peers that the environment is tried with, as `peers.toml` has them."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
RUNS_ON = ("gymnasium", "llvmlite", "numba", "numpy", "platformdirs", "torch")


@dataclass(frozen=True)
class Peer:
    """Who is tried, and how; `peers.toml` says what each field is."""

    name: str
    title: str
    requirements: tuple[str, ...]
    python: tuple[str, str]
    tried: str
    commands: tuple[str, ...]

    def constraints(self) -> list[str]:
        """Return the pins of constraints.txt of what the environment runs on and the peer leaves.

        Not of everything: a trainer may need others of what it brings along.
        """
        wanted = {*RUNS_ON} - {package(pin) for pin in self.requirements}
        lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
        return [line for line in lines if package(line) in wanted]


def package(pin: str) -> str:
    """Return the name of what is pinned, as package indices spell it."""
    return pin.partition("==")[0].lower().replace("_", "-")


def read_peers() -> dict[str, Peer]:
    """Return the peers by their names."""
    tables = tomllib.loads((HERE / "peers.toml").read_text(encoding="utf-8"))["peers"]
    lists = [
        {key: tuple(value) if isinstance(value, list) else value for key, value in table.items()}
        for table in tables
    ]
    return {table["name"]: Peer(**table) for table in lists}
