"""Compares games on a graphics card with this processor's, in bits and in speed, and with peers.

Run: python tests/benchmarks/gpu.py [--device cpu] [--quick]

1. games: both play the same decisions, and every number is compared; at most 100,000 decisions of
   4,096 worlds, and for --patience seconds a game. 600 are enough for all of them on 16 cores.
2. speed: decisions per second, with random actions that are drawn before, after the games have
   drifted apart.
3. training: decisions per second of the loop alone; then `quick` and `lite` are trained, for about
   10 and 60 s on an H100, and play as `arkanoid evaluate` does, beside the packaged `lite`.
4. peers: those that can be imported: gymnax, PufferLib, env-breakoutatari2600-turbo-native.

A ratio says how many times as fast a row is as all cores with the same games. All parts take an
H100 less than five minutes.
"""

import argparse
import itertools
import os
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from importlib.metadata import version
from multiprocessing import get_context
from typing import Any

import arkanoid  # noqa: F401
import numpy as np
import torch
from arkanoid.envs.state import INFO_FIELDS
from arkanoid.envs.tensors.entries import STEPS
from arkanoid.physics.kernels.portable.ptx import make_ptx
from cards.measuring import ACTIONS, QUICK, THOROUGH, Effort, make, player, rate, say, waiting
from cards.peers import show_peers
from cards.training import show_training

LITE, FULL = "ArkanoidLite-v0", "Arkanoid-v0"
GREY = {"observation": "rgb", "grey": True}
SAME, NEXT, DISABLED = ({"autoreset_mode": mode} for mode in ("SameStep", "NextStep", "Disabled"))
LIVELY = {"life_penalty": 1.0, "levels": "train", "lives": 1}
SHORT = LIVELY | {"max_decisions": 40, "capsule_rate": 1.0}
BOTH = {"observation": "dict", "actions": "box"}
LIVES = {"observation": "grid", "episodic_life": True}
# What is compared: label, id, keywords, whether with fewer worlds and for a part of the time.
COMPARED: list[tuple[str, str, dict[str, Any], bool]] = [
    ("lite, landing", LITE, LIVELY | SAME | {"landing": True}, False),
    ("full, landing", FULL, LIVELY | SAME | {"landing": True}, False),
    ("full, next step", FULL, SHORT | NEXT, True),
    ("full, resets by hand", FULL, SHORT | DISABLED, True),
    ("full, grid, lives as episodes", FULL, LIVES | SAME, True),
    ("full, 2 pictures", FULL, SHORT | SAME | GREY | {"stack": 2}, True),
    ("full, pictures and vector, velocities", FULL, SHORT | SAME | BOTH, True),
]
# What is measured: label, id, keywords, the numbers of worlds.
KINDS: list[tuple[str, str, dict[str, Any], tuple[int, ...]]] = [
    ("lite, vector", LITE, {}, (4096, 16384, 65536, 262144, 1048576)),
    ("lite, landing", LITE, {"landing": True}, (65536, 262144)),
    ("full, vector", FULL, {}, (4096, 65536, 262144)),
    ("full, grid", FULL, {"observation": "grid"}, (32768,)),
    ("lite, picture", LITE, GREY | {"stack": 1}, (4096, 32768)),
    ("lite, 4 pictures", LITE, GREY | {"stack": 4}, (4096, 32768)),
]
PARTS = ("games", "speed", "training", "peers")


class Judge:
    """Tells whether tensors always had the bits of arrays; it does not wait for the device."""

    def __init__(self, device: str) -> None:
        self.device = device
        self.same = torch.ones((), dtype=torch.bool, device=device)

    def compare(self, found: Any, wanted: Any) -> None:
        """Compare a tensor with an array, or dictionaries and lists of them."""
        if isinstance(wanted, dict):
            for key in wanted:
                self.compare(found[key], wanted[key])
        elif isinstance(wanted, list):
            for pair in zip(found, wanted, strict=True):
                self.compare(*pair)
        else:
            other = torch.from_numpy(np.array(wanted)).to(self.device)
            assert (found.shape, found.dtype) == (other.shape, other.dtype)
            # As bytes: 0 is not -0.
            same = found.contiguous().view(torch.uint8) == other.view(torch.uint8)
            self.same &= same.all()


def compare(
    device: str, label: str, game: str, keywords: dict[str, Any], effort: Effort, part: bool
) -> None:
    """Play the same decisions in both ways, and say in how many anything was different."""
    worlds, share = (min(effort.worlds, 512), 0.1) if part else (effort.worlds, 1.0)
    env, other = (make(place, game, worlds, **keywords) for place in (device, None))
    judge, random = Judge(device), np.random.default_rng(0)
    judge.compare(env.reset(seed=1)[0], other.reset(seed=1)[0])
    num_actions = getattr(env.single_action_space, "n", None)
    begin, played, patience = time.perf_counter(), 0, share * effort.patience
    while played < effort.decisions and time.perf_counter() - begin < patience:
        actions: Any = random.uniform(-1.0, 1.0, (worlds, 2)).astype(np.float32)
        if num_actions is not None:
            actions = random.integers(0, num_actions, worlds)
        *found, infos = env.step(actions)
        *wanted, other_infos = other.step(actions)
        judge.compare(found, wanted)
        judge.compare(infos, {key: other_infos[key] for key in INFO_FIELDS})
        over = wanted[2] | wanted[3]
        for world in np.flatnonzero(over)[:4] if "final_obs" in infos else ():
            last = infos["final_obs"]
            one = {key: last[key][world] for key in last} if isinstance(last, dict) else last[world]
            judge.compare(one, other_infos["final_obs"][world])
        if keywords["autoreset_mode"] == "Disabled" and over.any():
            judge.compare(*(each.reset(options={"reset_mask": over})[0] for each in (env, other)))
        played += 1
    whole = bool(judge.same) and env.snapshot() == other.snapshot()
    result = "equal" if whole else "DIFFERENT"
    say(f"{label}, {worlds:,} worlds", f"{played * worlds:14,}  {result}")
    env.close()
    other.close()


def measure_ours(
    device: str | None, game: str, worlds: int, keywords: dict[str, Any], effort: Effort
) -> float:
    """Return the decisions per second of a kind of games."""
    env = make(device, game, worlds, **keywords)
    env.reset(seed=0)
    drawn = np.random.default_rng(0).integers(0, env.single_action_space.n, (ACTIONS, worlds))
    actions = list(drawn) if device is None else list(torch.from_numpy(drawn).to(device))
    found = rate(player(env, itertools.cycle(actions)), worlds, effort, waiting(device))
    env.close()
    return found


def show_ours(device: str, effort: Effort) -> None:
    """Print the rows of our games."""
    for kind, game, keywords, counts in KINDS:
        smaller = min(counts[-1], effort.most_worlds, 65536 if "vector" in kind else 8192)
        cores = measure_ours(None, game, smaller, keywords, effort)
        say(f"{kind}, {smaller:,} worlds, all cores", f"{cores:14,.0f}")
        for worlds in dict.fromkeys(min(count, effort.most_worlds) for count in counts):
            label = f"{kind}, {worlds:,} worlds, {device}"
            try:
                found = measure_ours(device, game, worlds, keywords, effort)
            except MemoryError as error:
                say(label, f"{'left out':>14}")
                print(f"    {error}"[:79])
                continue
            say(label, f"{found:14,.0f}{found / cores:9.2f} x")


def prepare() -> None:
    """Compile the kernels of all kinds of observations at the same time; they are kept on disk."""
    entries = [[run.entry for run in runs] for runs in STEPS.values()]
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        list(pool.map(make_ptx, entries))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--device", help="of torch; a card if there is one, or else left out")
    parser.add_argument("--quick", action="store_true", help="try it out; the figures mean nothing")
    parser.add_argument("--only", choices=PARTS, nargs="+", default=PARTS, help="some of the parts")
    parser.add_argument("--patience", type=float, help="seconds to compare each of both games")
    options = parser.parse_args()
    # JAX would take most of the card's memory for itself.
    os.environ.setdefault("XLA_PYTHON_CLIENT_PREALLOCATE", "false")
    effort = QUICK if options.quick else THOROUGH
    if options.patience is not None:
        effort = replace(effort, patience=options.patience)
    device = options.device or ("cuda" if torch.cuda.is_available() else None)
    if device is None:
        print("no graphics card: --device cpu --quick tries out what a card would do")
        return
    card = torch.cuda.get_device_name() if device.startswith("cuda") else "this processor"
    begin = time.perf_counter()
    print(f"{card}, torch {torch.__version__}, {os.cpu_count()} cores, numba {version('numba')}")
    if device.startswith("cuda"):
        prepare()
    if "games" in options.only:
        print("The same decisions on the device and on the processor:")
        for label, game, keywords, part in COMPARED:
            compare(device, label, game, keywords, effort, part)
    if "speed" in options.only:
        print("Decisions per second (x: times all cores with the same observations):")
        show_ours(device, effort)
    if "training" in options.only:
        print("Training, decisions per second (x: times a core):")
        show_training(device, effort)
    if "peers" in options.only:
        print("Peers, decisions per second:")
        show_peers(effort)
    print(f"{time.perf_counter() - begin:.0f} s")


if __name__ == "__main__":
    main()
