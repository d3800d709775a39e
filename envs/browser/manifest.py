"""The manifest: what lies where, by name, as JSON. So JavaScript knows no number of its own."""

from base64 import b64encode
from collections.abc import Mapping
from typing import Any

import numpy as np

from ...physics.kernels.portable.wasm import FREE_FROM
from ...physics.scenes.records import Meeting, Sandbox, Seen
from ...physics.world.state.records import Hit, Ray
from ...version import __version__
from .. import rules, state
from ..actions import COMMANDS, action_meanings
from ..batch.recorder import CHECK_EVERY
from ..batch.replays import NOTE_EVERY, plain_plan
from ..config import LIMITS, WHOLE_LIMITS, Config
from ..draw.view import FULL_HEIGHT, FULL_WIDTH, WALL_WIDTH
from ..game.rulebook import Rules
from ..levels.files import level_names, load_level
from ..levels.generator import (
    MAX_DENSITY,
    MAX_GOLD,
    MAX_ROWS,
    MAX_SILVER,
    MIN_DENSITY,
    MIN_ROWS,
    SYMMETRIES,
)
from ..levels.motifs import MOTIFS
from ..levels.plan import plan_levels
from ..levels.starts import AS_THE_CONFIGURATION_SAYS
from ..play.by_hand import BY_HAND
from ..play.hearing import TONES
from ..registration import resolve_config
from ..state import INFO_FIELDS, INFO_MEANINGS
from .collisions import describe_meetings
from .image import Image, lay_out
from .records import Block, Board, Game, Hearing, Network, Operation, Picture
from .worlds import describe_worlds

RECORDS = {
    "Game": Game,
    "World": state.World,
    "Outcome": state.Outcome,
    "Rules": Rules,
    "LevelEntry": state.LevelEntry,
    "Picture": Picture,
    "Hearing": Hearing,
    "Board": Board,
    "Block": Block,
    "Network": Network,
    "Operation": Operation,
    "Meeting": Meeting,
    "Sandbox": Sandbox,
    "Seen": Seen,
    "Hit": Hit,
    "Ray": Ray,
}
_RULES = (
    *("RULES_VERSION", "TICKS_PER_SECOND", "FIELD_WIDTH", "FIELD_HEIGHT", "COLUMNS", "ROWS"),
    *("CELLS", "LATTICE_TOP", "BRICK_WIDTH", "BRICK_HEIGHT", "PADDLE_TOP", "BALL_RADIUS"),
    *("BRICK_LETTERS", "CAPSULE_LETTERS", "EMPTY", "SILVER", "GOLD", "UNBREAKABLE"),
    *("BALL_SPEED", "DEFLECTIONS", "REWARDS"),
    *("IDLE_TICKS", "BOSS_HITS", "CATCH", "ENLARGE", "LASER", "NO_POWER"),
)
_STATE = (
    *("ABSENT", "HELD", "FLYING", "GAME_OVER", "LIFE_LOST", "NOT_TRUNCATED", "DECISION_LIMIT"),
    *("AS_CONFIGURED", "GIVEN_LAYOUT", "GIVEN_SEED", "REPEATED_SEED"),
)
_GAMES = {"full": "Arkanoid-v0", "lite": "ArkanoidLite-v0"}


def browser_games() -> dict[str, Config]:
    """Return the games of the package's page, by name.

    ``"full"`` and ``"lite"`` are as agents play them, with landings. In ``"full by tick"`` and
    ``"lite by tick"`` decisions are ticks: an agent that repeats an action, as often as
    `frame_skip` says in the game that it knows, sees and does the same. ``"full by hand"`` and
    ``"lite by hand"`` are as players play them.
    """
    games = {}
    for name, env_id in _GAMES.items():
        config = resolve_config(env_id, {"landing": True})
        games[name] = config
        games[f"{name} by tick"] = by_tick(config)
        games[f"{name} by hand"] = resolve_config(env_id, BY_HAND)
    return games


def by_tick(config: Config) -> Config:
    """Return the same game with a decision in each tick, and as many ticks."""
    keywords = config.plain()
    keywords["max_decisions"] *= config.frame_skip
    keywords["frame_skip"] = 1
    return Config.from_keywords(keywords)


def make_manifest(games: Mapping[str, Config]) -> dict[str, Any]:
    """Return the manifest of games, by name, for `json.dumps`.

    Raises:
        ValueError: a game's levels can't be read.
    """
    return {
        "version": __version__,
        "free": FREE_FROM,
        "records": {name: describe(dtype) for name, dtype in RECORDS.items()},
        "rules": {name: getattr(rules, name) for name in _RULES},
        "state": {name: getattr(state, name) for name in _STATE},
        "view": {"width": FULL_WIDTH, "height": FULL_HEIGHT, "wall": WALL_WIDTH},
        "checksums": {"every": CHECK_EVERY, "noted": NOTE_EVERY},
        "defaults": Config().plain(),
        "limits": WHOLE_LIMITS | LIMITS,
        "start": AS_THE_CONFIGURATION_SAYS,
        "infos": {
            key: {"field": field, "meaning": INFO_MEANINGS[key]}
            for key, field in INFO_FIELDS.items()
        },
        "generator": {
            "motifs": list(MOTIFS),
            "symmetries": list(SYMMETRIES),
            "rows": [MIN_ROWS, MAX_ROWS],
            "density": [MIN_DENSITY, MAX_DENSITY],
            "silver": [0.0, MAX_SILVER],
            "gold": [0.0, MAX_GOLD],
        },
        "tones": [tone.name for tone in TONES],
        "meetings": describe_meetings(),
        "worlds": describe_worlds(),
        "levels": [_level(name) for name in level_names()],
        "games": {name: _game(config) for name, config in games.items()},
    }


def describe(dtype: "np.dtype[Any]") -> dict[str, Any]:
    """Return the length of a record in bytes, and of each field type, place and shape.

    A type is a letter and a number of bytes, ``"f8"`` say, as NumPy writes it; or the fields of a
    record within.
    """
    fields = {}
    for name in dtype.names or ():
        part, place = dtype.fields[name][:2]  # type: ignore[index]
        base = part.base
        kind = base.str.lstrip("<>|=") if base.names is None else describe(base)
        fields[name] = {"type": kind, "place": place, "shape": list(part.shape)}
    return {"length": dtype.itemsize, "fields": fields}


def _level(name: str) -> dict[str, Any]:
    level = load_level(name)
    letters = "".join(rules.BRICK_LETTERS[kind] for kind in level.kinds.ravel())
    return {
        "name": name,
        "title": level.name,
        "comment": level.comment,
        "bricks": letters,
        "boss": level.boss,
    }


def _game(config: Config) -> dict[str, Any]:
    plan = plan_levels(config)
    table = COMMANDS.get(config.actions)
    return {
        "config": config.plain(),
        "of_the_game": config.of_the_game().plain(),
        "levels": plain_plan(plan),
        "commands": None if table is None else table.tolist(),
        "meanings": None if table is None else action_meanings(config.actions),
        **_image(lay_out(config, plan)),
    }


def _image(image: Image) -> dict[str, Any]:
    parts = {
        kind: {name: [part.start, part.stop] for name, part in layout.items()}
        for kind, layout in image.layouts.items()
    }
    return {
        "image": b64encode(image.content).decode(),
        "length": image.length,
        "addresses": image.addresses,
        "parts": parts,
        "shapes": image.shapes,
    }
