"""Snapshots and replays that somebody forged: refused, or harmless."""

import contextlib
import dataclasses
import errno
import json
import pickle
import struct
import tracemalloc
import zlib
from pathlib import Path

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv, Replay, atomic, play_replay
from arkanoid.envs.batch.replays import MOST_DECISIONS, NOTE_EVERY
from arkanoid.envs.draw.png import write_png
from arkanoid.envs.levels.files import parse_level
from arkanoid.envs.observe.planes import MAX_MARKS
from arkanoid.envs.ranges import OUTCOME_RANGES, WORLD_RANGES
from arkanoid.envs.state import Outcome, World
from helpers.forging import opened, sealed_again
from helpers.processes import run_python
from helpers.states import writable_state

# What kernels do with an index outside its array, they say.
CHECKED = {"NUMBA_BOUNDSCHECK": "1"}
HERE = Path(__file__).parent
GOLDEN = HERE / "golden.replay"


def begun(**keywords):
    """Return an environment in the middle of a game."""
    env = ArkanoidEnv(**keywords)
    env.reset(seed=0)
    for action in [3, 1, 1, 2, 4] * 8:
        env.step(action)
    return env


def altered(env, name, value, dtype=World):
    """Return a snapshot of an environment in which one field has another value."""
    snapshot = env.snapshot()
    content = opened(snapshot)
    end = len(content) - env._batch.observations.nbytes
    first = end - Outcome.itemsize - (World.itemsize if dtype is World else 0)
    record = np.frombuffer(content, dtype, 1, first)
    record[name] = value
    return sealed_again(snapshot, content)


def test_each_field_has_its_range():
    assert tuple(WORLD_RANGES) == World.names
    assert tuple(OUTCOME_RANGES) == Outcome.names


@pytest.mark.parametrize("dtype", [World, Outcome])
def test_numbers_out_of_their_ranges_are_refused_by_the_names_of_their_fields(dtype):
    """Some of these read or wrote beyond arrays: 1054 of 9842 forged snapshots crashed."""
    env = begun()
    before = env.snapshot()
    for name, (low, high) in (WORLD_RANGES if dtype is World else OUTCOME_RANGES).items():
        base = dtype[name].base
        # Bounds of more than 53 bits are rounded.
        values = [low - 1, high + 1 + (high >> 10)] if base.kind != "f" else [-1e20, 1e20, np.nan]
        for value in values:
            limits = np.iinfo(base) if base.kind in "iu" else None
            if base.kind == "b" or (limits and not limits.min <= value <= limits.max):
                continue
            with pytest.raises(ValueError, match=rf"world 0 can't be: {name} is"):
                env.restore(altered(env, name, value, dtype))
    assert env.snapshot() == before


@pytest.mark.parametrize(
    ("name", "value", "named"),
    [
        ("paddle_shape", 1, "paddle_half"),
        ("paddle_half", 2.0, "paddle_half"),
        ("paddle_x", 0.5, "paddle_x"),
        ("paddle_vx", 0.2, "paddle_vx"),
        ("fire", 0.5, "fire"),
        ("power", 2, "paddle_half"),
        ("ball_state", 0, "ball_state"),
        ("ball_x", 0.0, "ball_x"),
        ("ball_vx", 1.0, "ball_vx"),
        ("decisions", 27_000, "decisions"),
        ("first_decision", 41, "first_decision"),
        ("lives", 0, "lives"),
        ("done", 2, "done"),
        ("next_life", 10**6, "next_life"),
        ("kind", 0, "brick_hits"),
        ("brick_hits", 2, "brick_hits"),
        ("hits_left", 1, "hits_left"),
        ("bricks_left", 1, "bricks_left"),
        ("needed", 1, "needed"),
        ("beams", 1, "beams"),
        ("beam_state", 1, "beam_state"),
        ("enemies", 3, "enemies"),
        ("enemy_state", 2, "enemy_side"),
        ("enemy_wait", 0, "enemy_wait"),
        ("boss_hits", 3, "hits_left"),
        ("shards", 1, "shards"),
        ("shard_state", 2, "shard_vx"),
        ("start_difficulty", -0.5, "start_difficulty"),
        ("start", 1, "start_kind"),
    ],
)
def test_fields_that_do_not_go_together_are_refused_by_their_names(name, value, named):
    """For instance, the loop that looks for a free beam found none and went beyond the array."""
    env = begun()
    before = env.snapshot()
    with pytest.raises(ValueError, match=rf"world 0 can't be: {named} is"):
        env.restore(altered(env, name, value))
    with pytest.raises(ValueError, match=rf"world 0 can't be: {named} is"):
        ArkanoidVectorEnv(3).spread(altered(env, name, value))
    assert env.snapshot() == before


def test_the_world_that_is_wrong_is_named():
    env = ArkanoidVectorEnv(5)
    env.reset(seed=0)
    env._batch.worlds["enemy_kind"][3] = 4
    with pytest.raises(ValueError, match="world 3 can't be: enemy_kind"):
        env.restore(env.snapshot())


def test_a_pickle_is_checked_like_a_snapshot():
    env = begun()
    writable_state(env).capsule = 8
    with pytest.raises(ValueError, match="capsule is 8"):
        pickle.loads(pickle.dumps(env))
    fresh = ArkanoidEnv()
    writable_state(fresh).lives = 8
    with pytest.raises(ValueError, match="without random numbers"):
        pickle.loads(pickle.dumps(fresh))


@pytest.mark.parametrize("value", [np.nan, 1.5, -np.inf])
@pytest.mark.parametrize("observation", ["vector", "grid", "dict"])
def test_observations_out_of_their_space_are_refused(observation, value):
    env = begun(observation=observation)
    shown = env._batch.observations
    (shown["vector"] if observation == "dict" else shown)[0].flat[3] = value
    with pytest.raises(ValueError, match="an observation can't be"):
        env.restore(env.snapshot())


def test_a_grid_full_of_things_is_refused():
    """The observer remembers where things are, in an array that has room for those of a game."""
    env = begun(observation="grid")
    grid = env._batch.observations[0].reshape(-1)
    grid[-MAX_MARKS - 1 :] = 0.5
    with pytest.raises(ValueError, match="more moving things than a game has"):
        env.restore(env.snapshot())


def test_parts_that_are_missing_are_refused():
    env = begun()
    snapshot = env.snapshot()
    content = opened(snapshot)
    setup = content.index(b"{")
    for forged in (
        content[:5],
        content[:-1],
        content + b"x",
        content[:4] + (2**32 - 1).to_bytes(4, "little") + content[8:],
        content[:4] + bytes(4) + content[8:],
        content[:setup] + b"[" * 100_000,
        content.replace(b'"rules"', b'"roles"'),
        content.replace(b'"config": {"', b'"config":[{"', 1),
    ):
        with pytest.raises(ValueError, match="corrupt"):
            env.restore(sealed_again(snapshot, bytes(forged)))


def test_forged_snapshots_do_no_harm():
    """No crash, no hang, no value outside its space, no unpromised error: one of nine crashed."""
    run_python(HERE / "forge_snapshots.py", "400", "0", warnings="default", changes=CHECKED)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_a_hundred_thousand_forged_snapshots_do_no_harm(seed):
    run_python(
        *(HERE / "forge_snapshots.py", "10000", str(seed)),
        **{"warnings": "default", "changes": CHECKED, "timeout": 3600.0},
    )


def test_forged_replays_do_no_harm():
    """They raised errors of zlib and struct, KeyErrors and AttributeErrors, too."""
    run_python(HERE / "forge_replays.py", "600", "0", warnings="default", changes=CHECKED)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_a_hundred_thousand_forged_replays_do_no_harm(seed):
    run_python(
        *(HERE / "forge_replays.py", "25000", str(seed)),
        **{"warnings": "default", "changes": CHECKED, "timeout": 3600.0},
    )


def rewritten(edit, commands=None, encode=str.encode):
    """Return the golden replay with another JSON, which `edit` changes in place."""
    replay = GOLDEN.read_bytes()
    content = bytes(opened(replay))
    (length,) = struct.unpack_from("<I", content)
    head = json.loads(zlib.decompress(content[4 : 4 + length]))
    edit(head)
    text = zlib.compress(encode(json.dumps(head)))
    packed = content[4 + length :] if commands is None else commands
    return sealed_again(replay, struct.pack("<I", len(text)) + text + packed)


@pytest.mark.parametrize(
    ("edit", "said"),
    [
        (lambda head: head.pop("result"), "corrupt"),
        (lambda head: head.update(config=[]), "corrupt"),
        (lambda head: head["config"].update(episodic_life=True), "how the game is seen"),
        (lambda head: head["config"].update(observation="rgb", size=4096), "how the game is seen"),
        (lambda head: head.update(version="1.0\x1b[2J"), "corrupt"),
        (lambda head: head.update(version=None), "corrupt"),
        (lambda head: head.update(palette=[[0.0, 0.0]]), "corrupt"),
        (lambda head: head.update(palette=[]), "corrupt"),
        (lambda head: head["result"].update(decisions=2780), "corrupt"),
        (lambda head: head["result"].update(decisions=10**9), "at most 10,000,000 decisions"),
        (lambda head: head["start"].update(random=1.5e300), "start.random"),
        (lambda head: head["start"].update(layout="w" * 199), "a layout is at most 198"),
        (lambda head: head["start"]["fields"].update(start=1), "nothing to hit"),
        (lambda head: head["levels"]["bricks"].__setitem__(0, "X" * 198), "nothing to hit"),
        (lambda head: head["levels"].update(first_difficulty=float("nan")), "first_difficulty"),
        (lambda head: head["levels"].update(names=["Ripple"]), "no game has such levels"),
        # They were said to begin differently.
        (lambda head: head.update(checksums=[]), "it has 0 checksums, and a game of"),
        (lambda head: head["checksums"].pop(), "corrupt: it has .* checksums"),
        (lambda head: head["checksums"].append(0), "corrupt: it has .* checksums"),
    ],
)
def test_what_is_no_replay_is_a_value_error(edit, said):
    with pytest.raises(ValueError, match=said):
        Replay.from_bytes(rewritten(edit))


@pytest.mark.parametrize(
    "encode",
    [
        lambda text: text.encode().replace(b'"version": "', b'"version": "\xff'),
        lambda text: text.encode("utf-16"),
        lambda text: text.encode("utf-16-le"),
        lambda text: text.encode("utf-32"),
        lambda text: text.encode("utf-8-sig"),
        lambda text: text[:-1].encode(),
        lambda text: b"",
    ],
)
def test_a_replays_json_is_in_utf_8(encode):
    """Of other letters there was a UnicodeDecodeError, and JSON in UTF-16 was taken."""
    with pytest.raises(ValueError, match="the replay is corrupt: ") as caught:
        Replay.from_bytes(rewritten(lambda head: None, encode=encode))
    assert type(caught.value) is ValueError


def test_a_replay_has_the_checksums_of_its_decisions():
    """A game that is over has none of its last state, whose place the result takes."""
    for count in (0, 1, NOTE_EVERY - 1, NOTE_EVERY, NOTE_EVERY + 1, 2 * NOTE_EVERY):
        for limit in (max(1, count), 10_000):
            env = ArkanoidEnv(lives=1000, max_decisions=limit)
            recorder = env.record()
            env.reset(seed=0)
            for _ in range(count):
                env.step(0)
            play_replay(Replay.from_bytes(recorder.replay().to_bytes()))


OTHERS = [
    *(None, True, -1, 0, 1.5, 10**400, 1e308, -1e308, float("nan"), "", "\x1b[31m", [], {}),
    json.loads("[" * 500 + "]" * 500),
]


def leaves(value, path=()):
    """Return the paths to all values of a replay's JSON, of the longer lists only to the first."""
    if isinstance(value, dict):
        return [path, *(way for key in value for way in leaves(value[key], (*path, key)))]
    if isinstance(value, list) and value:
        return [path, *leaves(value[0], (*path, 0))]
    return [path]


def changed(head, way, value):
    *path, last = way
    for key in path:
        head = head[key]
    head[last] = value


def test_a_value_of_another_type_is_refused():
    """A fraction was taken for a seed or a round, and null for "there is no boss"."""
    content = bytes(opened(GOLDEN.read_bytes()))
    (length,) = struct.unpack_from("<I", content)
    golden = json.loads(zlib.decompress(content[4 : 4 + length]))
    types = {way: type(found(golden, way)) for way in leaves(golden)[1:]}
    assert len(types) > 40
    for way, old in types.items():
        for value in OTHERS:
            forged = rewritten(lambda head, way=way, value=value: changed(head, way, value))
            fits = type(value) is old or (type(value), old) == (int, float)
            if fits or way[0] == "config":
                with contextlib.suppress(ValueError):
                    Replay.from_bytes(forged)
            else:
                with pytest.raises(ValueError, match="corrupt"):
                    Replay.from_bytes(forged)


def found(value, way):
    for key in way:
        value = value[key]
    return value


@pytest.mark.parametrize(
    ("way", "value"),
    [
        *((("start", "fields", name), 1.0) for name in ("start", "start_round", "start_seed")),
        (("start", "fields", "start_boss"), True),
        (("levels", "seeds"), [0, 100, 5]),
        (("levels", "seeds"), [0.0, 100]),
        (("levels", "boss"), [None] * 13),
        (("levels", "boss"), [0] * 13),
        (("levels", "names"), "abcdefghijklm"),
        (("result", "score"), 1.0),
        (("result", "terminated"), 1),
        (("result", "more"), 1),
        (("palette", 0), ["0.5", "1"]),
        (("checksums", 0), -1),
        (("more",), 1),
    ],
)
def test_what_python_takes_for_something_else_is_refused(way, value):
    with pytest.raises(ValueError, match="corrupt"):
        Replay.from_bytes(rewritten(lambda head: changed(head, way, value)))


def test_a_replay_expands_to_no_more_than_its_decisions_take():
    """A file of 1 MB asked for 16 GB of memory."""
    bomb = zlib.compress(bytes(1 << 26))

    def edit(head):
        head["palette"] = None

    for forged in (rewritten(edit, bomb), rewritten(lambda head: None, bomb)):
        tracemalloc.start()
        with pytest.raises(ValueError, match="corrupt"):
            Replay.from_bytes(forged)
        assert tracemalloc.get_traced_memory()[1] < 1 << 20
        tracemalloc.stop()
    text = zlib.compress(b" " * (1 << 25))
    forged = sealed_again(GOLDEN.read_bytes(), struct.pack("<I", len(text)) + text)
    with pytest.raises(ValueError, match="corrupt"):
        Replay.from_bytes(forged)


def test_a_game_too_long_for_a_file_is_not_written(tmp_path):
    replay = Replay.load(GOLDEN)
    commands = np.broadcast_to(replay.commands[:1], (MOST_DECISIONS + 1, 2))
    with pytest.raises(ValueError, match="at most 10,000,000 decisions"):
        dataclasses.replace(replay, commands=commands).save(tmp_path / "long.replay")
    assert list(tmp_path.iterdir()) == []


def test_a_failed_write_leaves_the_old_file(tmp_path, monkeypatch):
    """On a full disk, what was there before was lost."""
    replay, picture = Replay.load(GOLDEN), np.zeros((4, 4, 3), np.uint8)
    for name, write in [
        ("some.replay", replay.save),
        ("some.png", lambda path: write_png(path, picture)),
    ]:
        path = tmp_path / name
        write(path)
        before = path.read_bytes()

        def fail(descriptor):
            raise OSError(errno.ENOSPC, "No space left on device")

        with monkeypatch.context() as patched:
            patched.setattr(atomic.os, "fsync", fail)
            with pytest.raises(OSError, match="No space left"):
                write(path)
        assert path.read_bytes() == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["some.png", "some.replay"]


def test_names_that_steer_terminals_are_refused():
    with pytest.raises(ValueError, match=r"line 1: name has characters .*\\x1b"):
        parse_level("name: \x1b[2Jnothing\n...www.....\n", "a.txt")
