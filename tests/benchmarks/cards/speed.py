"""How fast our own games are on a device."""

import itertools
from typing import Any

import numpy as np
import torch

from .comparing import FULL, LITE
from .measuring import ACTIONS, GREY, Effort, make, player, rate, say, verdict, waiting

Kind = tuple[str, str, dict[str, Any], tuple[int, ...], float | None]
# What is measured: label, id, keywords, the numbers of worlds, the goal in decisions per second.
GOALS: list[Kind] = [
    ("lite, vector", LITE, {}, (262144, 1048576, 65536), 200e6),
    ("lite, picture", LITE, GREY | {"stack": 1}, (32768,), 20e6),
]
OTHERS: list[Kind] = [
    ("full, vector", FULL, {}, (4096, 65536, 262144), None),
    ("lite, vector", LITE, {}, (4096, 16384), None),
    ("lite, landing", LITE, {"landing": True}, (65536, 262144), None),
    ("full, grid", FULL, {"observation": "grid"}, (32768,), None),
    ("lite, 4 pictures", LITE, GREY | {"stack": 4}, (4096, 32768), None),
    ("lite, picture", LITE, GREY | {"stack": 1}, (4096,), None),
]


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


def show_ours(device: str, kinds: list[Kind], effort: Effort) -> None:
    """Print the rows of our games."""
    for kind, game, keywords, counts, goal in kinds:
        best = 0.0
        smaller = min(counts[0], effort.most_worlds, 16384 if "vector" in kind else 4096)
        cores = measure_ours(None, game, smaller, keywords, effort)
        say(f"{kind}, {smaller:,} worlds, all cores", f"{cores:14,.0f}")
        for worlds in dict.fromkeys(min(count, effort.most_worlds) for count in counts):
            label = f"{kind}, {worlds:,} worlds, {device}"
            try:
                found = measure_ours(device, game, worlds, keywords, effort)
            except (MemoryError, torch.OutOfMemoryError) as error:
                say(label, f"{'left out':>14}")
                print(f"    {error}"[:79], flush=True)
                continue
            best = max(best, found)
            say(label, f"{found:14,.0f}{found / cores:9.2f} x")
        if goal is not None:
            verdict(effort, f"{goal:,.0f} a second", best >= goal)
