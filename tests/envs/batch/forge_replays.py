"""Reads forged replays, and plays those that are accepted.

Run: NUMBA_BOUNDSCHECK=1 python tests/envs/batch/forge_replays.py COUNT SEED
It prints how many were refused and accepted. It fails if anything but a ValueError is raised, or,
in play, a ReplayDivergedError; the caller sees crashes and hangs.
"""

import faulthandler
import json
import struct
import sys
import zlib
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2]))

from arkanoid.envs import ArkanoidEnv, Replay, ReplayDivergedError, play_replay
from helpers.forging import opened, sealed_again

SECONDS = 120  # in which one of them is played, or it hangs
ODD: list[Any] = [
    *(None, True, False, 0, 1, -1, 2, 1.5, 255, 2**31, 2**63, 2**64, 10**400, 1e308, -1e308),
    *(float("nan"), float("inf"), "", "x", "\x1b[2J", "a\nb", "w" * 300, [], {}, [1], {"a": 1}),
    *([[]], [0, 2**63 - 1], [[0.0, 1.0]], [["x", 1]], "S" * 198, "X" * 198),
]
SETUPS: list[dict[str, Any]] = [
    {"levels": ["warden", "ripple"], "lives": 1, "capsule_rate": 1.0},
    {"levels": "train", "actions": "box", "max_decisions": 50},
    {},
]


def recorded(keywords: dict[str, Any], decisions: int, options: dict[str, Any] | None) -> bytes:
    """Return a replay of random play."""
    env = ArkanoidEnv(**keywords)
    env.action_space.seed(0)
    recorder = env.record()
    env.reset(seed=decisions, options=options)
    for _ in range(decisions):
        if recorder.over:
            break
        env.step(env.action_space.sample())
    return recorder.replay().to_bytes()


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the paths of all values in what JSON holds."""
    found = [path]
    if isinstance(value, dict):
        found += [place for key in value for place in places(value[key], (*path, key))]
    elif isinstance(value, list):
        found += [place for i in range(len(value)) for place in places(value[i], (*path, i))]
    return found


def change(rng: np.random.Generator, head: Any) -> tuple[Any, ...]:
    """Change something in the JSON of a replay; return where."""
    *path, last = (paths := places(head))[rng.integers(1, len(paths))]
    part = head
    for key in path:
        part = part[key]
    way = rng.integers(4)
    if way == 0:
        del part[last]
    elif way == 1 and type(part[last]) in (int, float):
        part[last] += type(part[last])(rng.integers(-2, 3))
    elif way == 2 and isinstance(part, dict):
        part[str(rng.integers(9))] = deepcopy(part[last])
    else:
        # A copy: a list in itself is no JSON.
        part[last] = deepcopy(ODD[rng.integers(len(ODD))])
    return (*path, last)


def forged(rng: np.random.Generator, replay: bytes) -> tuple[bytes, Any]:
    """Return a replay with something else in it, and where."""
    content = bytes(opened(replay))
    (length,) = struct.unpack_from("<I", content)
    text, commands = content[4 : 4 + length], content[4 + length :]
    where: Any = "commands"
    way = rng.random()
    if way < 0.8:
        head = json.loads(zlib.decompress(text))
        where = [change(rng, head) for _ in range(int(rng.integers(1, 4)))]
        text = zlib.compress(json.dumps(head).encode())
    elif way < 0.85:
        broken = bytearray(zlib.decompress(commands))
        broken[rng.integers(len(broken))] = rng.integers(256)
        commands = zlib.compress(bytes(broken))
    else:
        broken = bytearray(struct.pack("<I", length) + text + commands)
        broken[rng.integers(len(broken))] ^= 1 << int(rng.integers(8))
        return sealed_again(
            replay, bytes(broken[: rng.integers(len(broken)) if way > 0.97 else None])
        ), "bytes"
    return sealed_again(replay, struct.pack("<I", len(text)) + text + commands), where


def check(message: str) -> None:
    """Assert that an error's message does not steer the terminal on which it is shown."""
    assert message.isprintable(), message


def main() -> None:
    """Forge so many replays."""
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    rng = np.random.default_rng(seed)
    replays = [
        recorded(keywords, decisions, options)
        for keywords in SETUPS
        for decisions, options in [(30, None), (60, {"seed": 3}), (40, {"level": "vault"})]
    ]
    refused = accepted = 0
    for _ in range(count):
        faulthandler.dump_traceback_later(SECONDS, exit=True)
        data, where = forged(rng, replays[rng.integers(len(replays))])
        try:
            try:
                replay = Replay.from_bytes(data)
            except ValueError as error:
                refused += 1
                check(str(error))
                continue
            accepted += 1
            try:
                play_replay(replay)
            except ReplayDivergedError as error:
                check(str(error))
        except BaseException:
            print(where, flush=True)
            raise
    faulthandler.cancel_dump_traceback_later()
    print(f"{refused} refused, {accepted} accepted")


if __name__ == "__main__":
    main()
