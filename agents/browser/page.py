"""The page as one HTML file, which needs no other file and no network.

What is large is packed, and so are its modules. These import each other by bare names,
``"arkanoid/play"``, for which ``markup/unpack.js`` makes addresses.
"""

import json
import re
from base64 import b64decode
from collections.abc import Mapping, Sequence
from html import escape
from importlib import resources
from typing import Any

from ...envs import browser as machine_room
from ...envs.browser.manifest import browser_games, by_tick, make_manifest
from ...envs.browser.shipped import game_module
from ...envs.config import MOST_DECISIONS, Config
from .agents import BrowserAgent
from .facts import page_facts, page_icon
from .packing import pack, split_planes

# The parts of the page: the names of their addresses and panels, and of their tabs.
_PARTS = {
    "play": "Play",
    "watch": "Watch",
    "replay": "Replay",
    "editor": "Editor",
    "collide": "Collide",
    "world": "World",
}
_FOLDERS = ("modules", "watching", "collisions", "worlds")
# Of `browser_games`: those that people play, and those that agents were trained in.
_GAMES = ("full by hand", "lite by hand", "full", "lite")
_PLACEHOLDER = re.compile(r"\{\{(\w+)\}\}")
# How the modules of `envs.browser` import each other: as files in one folder.
_RELATIVE = re.compile(r'(?<=from )"\./(\w+)\.js"')
_PREFIX = "arkanoid/"
_HERE = resources.files(str(__package__))


def make_page(
    agents: Sequence[BrowserAgent],
    opens: str = "play",
    run: Mapping[str, Any] | None = None,
    asked: Mapping[str, Any] | None = None,
) -> str:
    """Return the page, as HTML.

    Args:
        agents: which can be watched, the first one at first.
        opens: which of its parts is shown where the address names none: ``"watch"``, say.
        run: which the first agent belongs to, as `FollowedRun.news` tells of it; None for none.
        asked: the levels that are watched at first: their ``title``, and in ``starts`` how a game
            of each begins, for `Game.reset`.

    Raises:
        ImportError: there is no linker for WebAssembly.
    """
    games = {name: game for name, game in browser_games().items() if name in _GAMES}
    shown = [{"name": agent.name, "game": _add_game(games, agent)} for agent in agents]
    facts = page_facts() | {"agents": shown, "run": run, "asked": asked}
    manifest = make_manifest(games)
    # Base64 hides that they are nearly the same.
    images = [b64decode(game["image"]) for game in manifest["games"].values()]
    for game, image in zip(manifest["games"].values(), images, strict=True):
        game["image"] = len(image)
    data = {
        "modules": _json(_modules()),
        "code": game_module(),
        "images": b"".join(images),
        "manifest": _json(manifest),
        "facts": _json(facts),
    }
    elements = [_element(name, content) for name, content in data.items()]
    elements += [
        _element(f"agent-{agent.name}", agent.network, width=4) for agent in agents if agent.network
    ]
    return _fill(
        _read("index.html"),
        {
            "icon": page_icon(),
            "opens": opens,
            "style": _read("style.css"),
            "tabs": " ".join(f'<a href="#{name}">{title}</a>' for name, title in _PARTS.items()),
            "scene": _read("scene.html") + _read("arena.html"),
            "panels": "\n".join(map(_panel, _PARTS)),
            "unpack": _read("unpack.js"),
            "data": "\n".join(elements),
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


def _modules() -> dict[str, str]:
    """Return the code of each module, by its name."""
    folders = (resources.files(machine_room), *(_HERE / name for name in _FOLDERS))
    return {
        f"{_PREFIX}{file.name.removesuffix('.js')}": _code(file)
        for folder in folders
        for file in sorted(folder.iterdir(), key=lambda file: file.name)
        if file.name.endswith(".js")
    }


def _code(file: Any) -> str:
    code = _RELATIVE.sub(rf'"{_PREFIX}\1"', file.read_text(encoding="utf-8"))
    # The last line is the name that browsers show where something fails.
    return f"{code}//# sourceURL={_PREFIX}{file.name}\n"


def _element(name: str, content: bytes, width: int = 1) -> str:
    """Return an element that holds bytes: of numbers that have `width` bytes each."""
    packed = pack(split_planes(content, width))
    return (
        f'<script type="text/plain" id="data-{escape(name)}" data-width="{width}">{packed}</script>'
    )


def _json(value: object) -> bytes:
    return json.dumps(value, separators=(",", ":")).encode()
