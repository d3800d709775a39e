"""The module that browsers run gives the bits of the processor: in states, views and checksums.

Node.js does the jobs of all tests in one process, see ``play.mjs``.
"""

import base64
import hashlib
import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from arkanoid.envs.actions import COMMANDS
from arkanoid.envs.batch.batch import Batch
from arkanoid.envs.batch.playback import play_replay, replay_states
from arkanoid.envs.batch.recorder import Recorder
from arkanoid.envs.batch.replays import Replay, plain_plan
from arkanoid.envs.browser.entries import ENTRIES
from arkanoid.envs.browser.manifest import browser_games, make_manifest
from arkanoid.envs.config import Config
from arkanoid.envs.draw.picture import draw_world
from arkanoid.envs.draw.scenery import LOOKS, lattice_size
from arkanoid.envs.draw.view import make_view
from arkanoid.envs.game.rulebook import make_rules
from arkanoid.envs.levels.clearability import unreachable_bricks
from arkanoid.envs.levels.files import CAMPAIGN
from arkanoid.envs.levels.generated import generate_level
from arkanoid.envs.levels.generator import MAX_SEED, SYMMETRIES
from arkanoid.envs.levels.motifs import MOTIFS
from arkanoid.envs.levels.plan import plan_levels
from arkanoid.envs.observe.planes import GridObserver
from arkanoid.envs.observe.vector import VectorObserver
from arkanoid.envs.play.by_hand import BY_HAND
from arkanoid.envs.play.hearing import tones_of
from arkanoid.envs.rules import BRICK_LETTERS, CELLS, COLUMNS, GOLD, ROWS
from arkanoid.envs.state import INFO_FIELDS
from arkanoid.physics.kernels.portable.wasm import make_wasm
from helpers.node import run_jobs
from helpers.plays import EVERYTHING
from helpers.repository import ROOT, TESTS

SOURCES = ROOT / "envs" / "browser"
GOLDEN = Replay.load(TESTS / "envs" / "batch" / "golden.replay")
MOST_BYTES = 700_000
ALL = np.ones(1, np.bool_)
# Height, width and channels: of agents, of people with and without a score line, and odd ones.
SIZES = ((84, 84, 1), (84, 84, 3), (210, 160, 3), (256, 192, 4), (31, 97, 4), (1, 1, 3))
RESIZED = [[size, size * 3 // 4] for size in (*range(30, 130), *range(130, 30, -1))]
PART = 250  # decisions that share a digest
# Games in which something is otherwise than in those of the page.
OTHERS = {
    "everything": EVERYTHING,
    "by points": {"reward": "score", "deflection": "physical", "landing": True, **EVERYTHING},
    "sticky": {"sticky_action": 0.25, "deflection": "zones6", "paddle": 2.0, "frame_skip": 7},
    "lives": {"episodic_life": True, "actions": "discrete4", "speed": 3.0, "reward": "sparse"},
    "generated": {"levels": "test", "difficulty": 1.0, "actions": "box", "life_penalty": 0.5},
}
GAMES = {
    **browser_games(),
    **{name: Config.from_keywords(keywords) for name, keywords in OTHERS.items()},
    "golden": GOLDEN.config,
}
# Games that the page does not know, of which there may be replays.
ELSEWHERE = {
    "one level again and again": {"levels": "seed:7", "difficulty": 0.5, **BY_HAND},
    "two levels": {"levels": ["moat", "warden"], "lives": 1, "reward": "score"},
    "fast": {"speed": 2.5, "life_penalty": 1.0, "deflection": "zones6", "capsules": False},
    "wide": {"paddle": 3.1, "frame_skip": 1, "actions": "box"},
    "narrow": {"paddle": 0.25, "deflection": "physical", "levels": "warden", "lives": 9},
    "without fire": {"actions": "discrete3", "frame_skip": 2, "enemies": False, "levels": "train"},
}
RULES = [
    *GAMES.values(),
    *(Config.from_keywords(keywords) for keywords in ELSEWHERE.values()),
]
# How many decisions of random play are compared, in `PART`s.
LENGTHS = {"full": 80, "lite": 40, "everything": 40}


def random_actions(config: Config, count: int, seed: int) -> list:
    luck = np.random.default_rng(seed)
    if config.actions in COMMANDS:
        return luck.integers(len(COMMANDS[config.actions]), size=count).tolist()
    moves = luck.uniform(-1.2, 1.2, count).astype(np.float32).tolist()
    return [[move, fire] for move, fire in zip(moves, luck.integers(2, size=count), strict=True)]


def playing(name: str, seed: int, reset: dict, count: int, draw_every: int = 25) -> dict:
    actions = random_actions(GAMES[name], count, seed)
    actions = [action if isinstance(action, int) else [*map(float, action)] for action in actions]
    job = {"work": "play", "game": name, "reset": {"seed": seed, **reset}, "actions": actions}
    return job | {"part": PART, "observeEvery": 3, "drawEvery": draw_every, "sizes": SIZES}


PLAYS = {
    **{
        name: playing(name, index, {}, PART * LENGTHS.get(name, 8))
        for index, name in enumerate(GAMES)
    },
    **{
        f"round {number}": playing("everything", number, {"level": number}, PART)
        for number in range(1, len(CAMPAIGN) + 2)
    },
    "spiral": playing("lite", 5, {"level": "spiral"}, PART),
    "not of the campaign": playing("generated", 5, {"level": "moat"}, PART),
    "seed": playing("full", 6, {"levelSeed": 7, "difficulty": 0.9}, PART),
    "again and again": playing("everything", 2**63, {"levelSeed": 7, "repeat": True}, PART),
}


def options(reset: dict) -> dict:
    """Return the options of Python's reset."""
    names = {"level": "level", "levelSeed": "seed", "repeat": "repeat", "difficulty": "difficulty"}
    return {names[name]: value for name, value in reset.items() if name != "seed"}


def play_here(job: dict) -> list[list[str]]:
    """Do a job of `playing` with the processor's kernels."""
    config, reset = GAMES[job["game"]], job["reset"]
    batch = Batch(1, config)
    vectors, grids = VectorObserver(config, 1), GridObserver(config, 1)
    shared = batch.worlds, batch.rules, slice(0, 1)
    observe = vectors.part(*shared), grids.part(*shared)
    batch.reset(ALL, options(reset), [reset["seed"]])
    digests: list[list[str]] = []
    for decision, action in enumerate(job["actions"]):
        if decision % job["part"] == 0:
            hashes = [hashlib.sha256() for _ in range(4)]
        if batch.worlds["done"][0]:
            batch.reset(ALL)
        batch.command(np.array([action]))
        batch.step()
        hashes[0].update(batch.worlds.tobytes() + batch.outcomes.tobytes())
        if decision % job["observeEvery"] == 0:
            for each in observe:
                each(ALL)
            hashes[1].update(vectors.observations.tobytes())
            hashes[2].update(grids.observations.tobytes())
        if decision % job["drawEvery"] == 0:
            for size in job["sizes"]:
                hashes[3].update(picture(batch, *size).tobytes())
        if (decision + 1) % job["part"] == 0:
            digests.append([each.hexdigest() for each in hashes])
    return digests


def picture(batch: Batch, height: int, width: int, channels: int) -> np.ndarray:
    """Return the picture that `render` gives; the fourth channel is full."""
    drawn = draw_world(batch.worlds, batch.rules, 0, height, width, min(channels, 3))
    opacity = np.full((height, width, 1), 255, np.uint8)
    return drawn if channels < 4 else np.concatenate([drawn, opacity], axis=2)


@cache
def recorded(name: str) -> Replay:
    """Return a game of `ELSEWHERE`, played at random."""
    config = Config.from_keywords(ELSEWHERE[name])
    batch = Batch(1, config)
    recorder = Recorder(batch, 0)
    batch.reset(ALL, None, [1])
    for action in random_actions(config, 600, 1):
        if recorder.over:
            break
        batch.command(np.array([action]))
        batch.step()
    return recorder.replay()


def encoded(name: str) -> str:
    return base64.b64encode(recorded(name).to_bytes()).decode()


def recipes() -> list[dict]:
    """Return 200 levels for the generator, every other one with parts of its recipe fixed."""
    luck = np.random.default_rng(3)
    levels = []
    for index in range(200):
        seed = int(luck.integers(MAX_SEED)) if index % 3 else index
        recipe = {}
        if index % 2:
            recipe = {
                "motif": list(MOTIFS)[index % len(MOTIFS)],
                "rows": int(luck.integers(4, 13)),
                "density": float(luck.uniform(0.35, 0.9)),
                "symmetry": list(SYMMETRIES)[index % len(SYMMETRIES)],
                "silver": float(luck.uniform(0.0, 0.3)),
                "gold": float(luck.uniform(0.0, 0.15)),
            }
        # As text: JSON's numbers have too few digits in JavaScript.
        levels.append({"seed": str(seed), "difficulty": float(luck.random()), "recipe": recipe})
    return levels


def layouts() -> list[str]:
    """Return layouts, many with gold that bars the way."""
    luck = np.random.default_rng(4)
    kinds = luck.integers(0, GOLD + 1, (200, CELLS))
    golden = luck.random((200, CELLS)) < luck.uniform(0.0, 0.7, (200, 1))
    return ["".join(BRICK_LETTERS[kind] for kind in row) for row in np.where(golden, GOLD, kinds)]


def jobs() -> dict:
    file = base64.b64encode(GOLDEN.to_bytes()).decode()
    hand = playing("full by hand", 9, {"level": 3}, 2000)
    box = [[round(32 * move) / 32, fire] for move, fire in hand["actions"]]
    return {
        **{f"play {name}": job for name, job in PLAYS.items()},
        "golden": {"work": "replay", "file": file},
        **{f"replay {name}": {"work": "replay", "file": encoded(name)} for name in ELSEWHERE},
        "rules": {
            "work": "rules",
            "games": [[config.plain(), plain_plan(plan_levels(config))] for config in RULES],
        },
        "recorded by hand": hand | {"work": "record", "actions": box},
        "recorded": playing("lite", 2**64 - 1, {"levelSeed": 5}, 2000) | {"work": "record"},
        "generate": {"work": "generate", "levels": recipes()},
        "search": {"work": "search", "layouts": layouts()},
        "restore": {
            "work": "restore",
            "game": "everything",
            "actions": random_actions(GAMES["everything"], 100, 7),
        },
        "hear": playing("everything", 4, {}, 5000) | {"work": "hear"},
        "resize": {"work": "resize", "sizes": RESIZED},
        "names": {"work": "names"},
        "mistakes": {
            "work": "mistakes",
            "plain": Config().plain(),
            "plan": plain_plan(plan_levels(Config())),
        },
    }


@cache
def module() -> bytes:
    return make_wasm(ENTRIES)


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory) -> dict:
    """Return what came of all jobs."""
    folder: Path = tmp_path_factory.mktemp("browser")
    (folder / "module.wasm").write_bytes(module())
    (folder / "manifest.json").write_text(json.dumps(make_manifest(GAMES)), encoding="utf-8")
    files = folder / "module.wasm", folder / "manifest.json"
    return run_jobs(Path(__file__).with_name("play.mjs"), folder, jobs(), SOURCES, *files)


@pytest.mark.parametrize("name", PLAYS)
def test_play(done: dict, name: str) -> None:
    """States, vectors, grids and pictures are equal byte for byte."""
    assert done[f"play {name}"] == play_here(PLAYS[name])


def test_the_golden_replay(done: dict) -> None:
    """Its checksums were compared, too, and it is written as it was read."""
    digest = hashlib.sha256()
    for batch in replay_states(GOLDEN):
        digest.update(batch.worlds.tobytes() + batch.outcomes.tobytes())
    assert done["golden"]["digest"] == digest.hexdigest()
    again = Replay.from_bytes(base64.b64decode(done["golden"]["again"]))
    assert again.commands.tobytes() == GOLDEN.commands.tobytes()
    assert plain_plan(again.plan) == plain_plan(GOLDEN.plan)
    same = {"commands": GOLDEN.commands, "plan": GOLDEN.plan}
    assert replace(again, **same) == GOLDEN


@pytest.mark.parametrize("name", ELSEWHERE)
def test_replays_of_games_that_the_page_does_not_know(done: dict, name: str) -> None:
    digest = hashlib.sha256()
    for batch in replay_states(recorded(name)):
        digest.update(batch.worlds.tobytes() + batch.outcomes.tobytes())
    found = done[f"replay {name}"]
    assert found["digest"] == digest.hexdigest()
    assert found["game"] == "a game"


def test_rules_from_a_configuration(done: dict) -> None:
    """JavaScript writes them as Python does, in every bit."""
    for config, found in zip(RULES, done["rules"], strict=True):
        assert base64.b64decode(found) == make_rules(config, plan_levels(config)).tobytes(), config


@pytest.mark.parametrize("name", ["recorded by hand", "recorded"])
def test_what_a_browser_records_plays_here(done: dict, name: str) -> None:
    replay = Replay.from_bytes(base64.b64decode(done[name]))
    assert play_replay(replay).decisions == len(replay.commands) > 0


def test_generated_levels(done: dict) -> None:
    found = []
    for level in recipes():
        made = generate_level(int(level["seed"]), difficulty=level["difficulty"], **level["recipe"])
        found.append("".join(BRICK_LETTERS[kind] for kind in made.kinds.ravel()))
    assert done["generate"] == found


def test_bricks_that_no_ball_can_reach(done: dict) -> None:
    for bricks, found in zip(layouts(), done["search"], strict=True):
        kinds = np.array([BRICK_LETTERS.index(letter) for letter in bricks], np.uint8)
        barred = unreachable_bricks(kinds.reshape(ROWS, COLUMNS))
        assert found["unreachable"] == [row * COLUMNS + column for row, column in barred]
        assert found["breakable"] == ((kinds > 0) & (kinds < GOLD)).sum()


def test_a_restored_state_goes_on_as_before(done: dict) -> None:
    first, again = done["restore"]
    assert first == again


def test_what_is_heard(done: dict) -> None:
    batch, heard = Batch(1, GAMES["everything"]), []
    batch.reset(ALL, None, [4])
    for action in random_actions(GAMES["everything"], 5000, 4):
        if batch.worlds["done"][0]:
            batch.reset(ALL)
        before = batch.worlds[0].copy()
        batch.command(np.array([action]))
        batch.step()
        tones = tones_of(before, batch.worlds[0], batch.outcomes[0])
        heard.append([tone.name for tone in tones])
    assert done["hear"] == heard
    assert {name for names in heard for name in names} >= {"WALL", "BRICK", "LIFE_LOST"}


def test_a_page_that_is_resized_takes_no_more_and_more_memory(done: dict) -> None:
    """Each size took memory of its own, which nobody gave back."""
    found = done["resize"]
    first, second = found["grown"]
    height, width = max(RESIZED)
    rows, columns = lattice_size(make_view(height, width)[0])
    largest = 4 * (2 * height * width + LOOKS * rows * columns)
    # All sizes together would take 40 times as much as the largest one.
    assert first == second < 2**21 + 24 * largest
    batch = Batch(1, GAMES["full"])
    batch.reset(ALL, None, [1])
    drawn = picture(batch, *RESIZED[-1], 4)
    assert found["digest"] == hashlib.sha256(drawn.tobytes()).hexdigest()


def test_fields_have_their_names(done: dict) -> None:
    batch = Batch(1, GAMES["full"])
    batch.reset(ALL, {"level": "spiral"}, [3])
    for decision in range(60):
        batch.commands[0] = decision % 3 - 1, 1
        batch.step()
    (world,), (outcome,) = batch.worlds, batch.outcomes
    here = {name: world[name].tolist() for name in world.dtype.names}
    for name in ("random", "first_random"):  # whose digits a number of JavaScript would lose
        here[name] = str(here[name])
    assert done["names"]["world"] == here
    assert done["names"]["info"] == {key: outcome[field] for key, field in INFO_FIELDS.items()}


@pytest.mark.parametrize(
    ("mistake", "message"),
    {
        "first": "the first reset needs a seed",
        "game": "no game chess: there are full,",
        "number": "lite has no action 3",
        "fraction": "lite has no action 0.5",
        "velocity": "velocity and fire must be numbers",
        "level": "no level nowhere",
        "brick": "? is no brick",
        "boss": "lite has no boss",
        "state": "these bytes are no state",
        "nothing": "this is no replay",
        "damaged": "the replay is damaged",
        "paddle": "paddle is 6, and not from 0.25 to 5",
        "ticks": "frame_skip is 0, and not from 1 to 1000",
        "unseen": "a game can't be observed",
        "early": "a recording begins with a reset",
    }.items(),
)
def test_mistakes_get_a_sentence(done: dict, mistake: str, message: str) -> None:
    assert message in done["mistakes"][mistake]


def test_the_module_is_small_and_needs_nothing() -> None:
    """It has no section of imports, which would be the second kind."""
    code = module()
    assert code.startswith(b"\0asm")
    assert len(code) < MOST_BYTES
    kinds, place = set(), 8
    while place < len(code):
        kind, length, place = code[place], 0, place + 1
        for index in range(5):
            byte = code[place]
            length |= (byte & 127) << 7 * index
            place += 1
            if byte < 128:
                break
        kinds.add(kind)
        place += length
    assert kinds >= {1, 3, 5, 7, 10}
    assert 2 not in kinds
