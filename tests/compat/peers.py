"""The libraries that the environment is tried with, as `peers.toml` lists them."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
# The environment runs on these. Where a peer does not pin one, it gets the version of
# constraints.txt. Everything else is left to the peer, which may need other versions.
RUNS_ON = ("gymnasium", "llvmlite", "numba", "numpy", "platformdirs", "torch")


@dataclass(frozen=True)
class Peer:
    """A library, and how it is tried; `peers.toml` explains the fields."""

    name: str
    title: str
    requirements: tuple[str, ...]
    python: tuple[str, str]
    tried: str
    commands: tuple[str, ...]
    alone: tuple[str, ...] = ()
    clones: tuple[str, ...] = ()

    def constraints(self) -> list[str]:
        """Return the pins of constraints.txt for what the environment runs on."""
        wanted = {*RUNS_ON} - {package(pin) for pin in self.requirements}
        lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
        return [line for line in lines if package(line) in wanted]

    def commits(self) -> dict[str, str]:
        """Return the commit of each repository that is cloned, by its name."""
        addresses = (clone.split("@") for clone in self.clones)
        return {Path(address).name.lower(): commit for address, commit in addresses}

    def supports(self, python: tuple[int, int]) -> bool:
        """Tell whether the requirements have wheels for a version of Python."""
        oldest, newest = (tuple(map(int, version.split("."))) for version in self.python)
        return oldest <= python <= newest


def package(pin: str) -> str:
    """Return the name of the pinned package, as package indices spell it."""
    return pin.partition("==")[0].lower().replace("_", "-")


def read_peers() -> dict[str, Peer]:
    """Return the peers by their names."""
    tables = tomllib.loads((HERE / "peers.toml").read_text(encoding="utf-8"))["peers"]
    lists = [
        {key: tuple(value) if isinstance(value, list) else value for key, value in table.items()}
        for table in tables
    ]
    return {table["name"]: Peer(**table) for table in lists}
