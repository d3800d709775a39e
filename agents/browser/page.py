"""The page as one HTML file, which needs no other file and no network.

Its modules import each other by bare names, ``"arkanoid/play"``, which an import map resolves to
``data:`` addresses. What is large is packed by zlib.
"""

import json
import re
import zlib
from base64 import b64encode
from collections.abc import Sequence
from html import escape
from importlib import resources
from typing import Any

from ...envs import browser as machine_room
from ...envs.browser.manifest import browser_games, by_tick, make_manifest
from ...envs.browser.shipped import game_module
from ...envs.config import MOST_DECISIONS, Config
from .agents import BrowserAgent
from .facts import page_facts, page_icon

# The parts of the page: the names of their addresses and panels, and of their tabs.
_PARTS = {
    "play": "Play",
    "watch": "Watch",
    "replay": "Replay",
    "editor": "Editor",
    "collide": "Collide",
    "world": "World",
}
_FOLDERS = ("modules", "collisions", "worlds")
# Of `browser_games`: those that people play, and those that agents were trained in.
_GAMES = ("full by hand", "lite by hand", "full", "lite")
_PLACEHOLDER = re.compile(r"\{\{(\w+)\}\}")
# How the modules of `envs.browser` import each other: as files in one folder.
_RELATIVE = re.compile(r'(?<=from )"\./(\w+)\.js"')
_PREFIX = "arkanoid/"
_HERE = resources.files(str(__package__))


def make_page(agents: Sequence[BrowserAgent], opens: str = "play") -> str:
    """Return the page, as HTML.

    Args:
        agents: which can be watched, the first one at first.
        opens: which of its parts is shown where the address names none: ``"watch"``, say.

    Raises:
        ImportError: there is no linker for WebAssembly.
    """
    games = {name: game for name, game in browser_games().items() if name in _GAMES}
    shown = [{"name": agent.name, "game": _add_game(games, agent)} for agent in agents]
    facts = page_facts()
    facts["agents"] = shown
    data = {
        "code": game_module(),
        "manifest": _json(make_manifest(games)),
        "facts": _json(facts),
    }
    data |= {f"agent-{agent.name}": agent.network for agent in agents}
    return _fill(
        _read("index.html"),
        {
            "icon": page_icon(),
            "opens": opens,
            "style": _read("style.css"),
            "tabs": " ".join(f'<a href="#{name}">{title}</a>' for name, title in _PARTS.items()),
            "scene": _read("scene.html") + _read("arena.html"),
            "panels": "\n".join(map(_panel, _PARTS)),
            "imports": json.dumps({"imports": _imports()}),
            "data": "\n".join(_data(name, content) for name, content in data.items()),
        },
    )


def _add_game(games: dict[str, Config], agent: BrowserAgent) -> str:
    """Add the game that an agent plays, tick by tick if that is the same; return its name."""
    config = agent.config
    ticks = config.max_decisions * config.frame_skip
    if not config.sticky_action and ticks <= MOST_DECISIONS:
        config = by_tick(config)
    name = f"{agent.name} at play"
    games[name] = config
    return name


def _fill(template: str, values: dict[str, str]) -> str:
    return _PLACEHOLDER.sub(lambda found: values[found[1]], template)


def _read(name: str) -> str:
    return (_HERE / "markup" / name).read_text(encoding="utf-8")


def _panel(name: str) -> str:
    return f'<section class="panel" id="panel-{name}" hidden>\n{_read(f"{name}.html")}</section>'


def _imports() -> dict[str, str]:
    """Return the address of each module, by its name."""
    folders = (resources.files(machine_room), *(_HERE / name for name in _FOLDERS))
    return {
        f"{_PREFIX}{file.name.removesuffix('.js')}": _address(file)
        for folder in folders
        for file in sorted(folder.iterdir(), key=lambda file: file.name)
        if file.name.endswith(".js")
    }


def _address(file: Any) -> str:
    code = _RELATIVE.sub(rf'"{_PREFIX}\1"', file.read_text(encoding="utf-8"))
    # The last line is the name that browsers show where something fails.
    content = f"{code}//# sourceURL={_PREFIX}{file.name}\n".encode()
    return f"data:text/javascript;base64,{b64encode(content).decode()}"


def _data(name: str, content: bytes) -> str:
    packed = b64encode(zlib.compress(content, 9)).decode()
    return f'<script type="text/plain" id="data-{escape(name)}">{packed}</script>'


def _json(value: object) -> bytes:
    return json.dumps(value, separators=(",", ":")).encode()
