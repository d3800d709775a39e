"""Games on a device beside the same games on this processor: every bit is compared."""

import time
from typing import Any

import numpy as np
import torch
from arkanoid.envs.state import INFO_FIELDS

from .measuring import GREY, Effort, make, say

LITE, FULL = "ArkanoidLite-v0", "Arkanoid-v0"
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
_NEVER = 1 << 62  # decisions
_LOOK_EVERY = 256  # decisions: to look waits for the device
_TELL_EVERY = 60.0  # seconds


class Judge:
    """Notes in which decision each part of the results was different for the first time.

    Only `verdict` waits for the device.
    """

    def __init__(self, device: str) -> None:
        self.device, self.decision = device, 0
        self.first: dict[str, torch.Tensor] = {}

    def compare(self, name: str, found: Any, wanted: Any) -> None:
        """Compare a tensor with an array, or dictionaries of them."""
        if isinstance(wanted, dict):
            for key in wanted:
                self.compare(f"{name} {key}", found[key], wanted[key])
            return
        other = torch.from_numpy(np.array(wanted)).to(self.device)
        assert (found.shape, found.dtype) == (other.shape, other.dtype), name
        # As bytes: 0 is not -0.
        different = (found.contiguous().view(torch.uint8) != other.view(torch.uint8)).any()
        now = torch.where(different, self.decision, _NEVER)
        self.first[name] = torch.minimum(self.first.get(name, now), now)

    def verdict(self) -> str:
        """Return "equal", or what was different, and where at first."""
        firsts = {name: int(first) for name, first in self.first.items()}
        decision = min(firsts.values())
        if decision == _NEVER:
            return "equal"
        names = ", ".join(name for name, first in firsts.items() if first == decision)
        return f"DIFFERENT: {names} in decision {decision}"


def compare(
    device: str, label: str, game: str, keywords: dict[str, Any], effort: Effort, part: bool
) -> None:
    """Play the same decisions in both ways, and say whether and where anything was different."""
    worlds, share = (min(effort.worlds, 512), 0.1) if part else (effort.worlds, 1.0)
    env, other = (make(place, game, worlds, **keywords) for place in (device, None))
    judge, random = Judge(device), np.random.default_rng(0)
    judge.compare("first observations", env.reset(seed=1)[0], other.reset(seed=1)[0])
    num_actions = getattr(env.single_action_space, "n", None)
    begin, told = time.perf_counter(), 0.0
    patience, verdict = share * effort.patience, "equal"
    while judge.decision < effort.decisions and verdict == "equal":
        seconds = time.perf_counter() - begin
        if seconds > patience:
            break
        if seconds > told + _TELL_EVERY:
            told = seconds
            say(f"  {label}, so far", f"{judge.decision * worlds:14,}  {judge.verdict()}")
        actions: Any = random.uniform(-1.0, 1.0, (worlds, 2)).astype(np.float32)
        if num_actions is not None:
            actions = random.integers(0, num_actions, worlds)
        judge.decision += 1
        play_both(judge, env, other, actions)
        if judge.decision % _LOOK_EVERY == 0:
            verdict = judge.verdict()
    verdict = judge.verdict()
    if verdict == "equal" and env.snapshot() != other.snapshot():
        verdict = "DIFFERENT: the snapshots at the end"
    say(f"{label}, {worlds:,} worlds", f"{judge.decision * worlds:14,}  {verdict}")
    env.close()
    other.close()


def play_both(judge: Judge, env: Any, other: Any, actions: Any) -> None:
    """Play a decision in both ways, and compare all that comes of it."""
    *found, infos = env.step(actions)
    *wanted, other_infos = other.step(actions)
    parts = ("observations", "rewards", "terminated", "truncated")
    for name, tensor, array in zip(parts, found, wanted, strict=True):
        judge.compare(name, tensor, array)
    compare_infos(judge, "infos", infos, other_infos)
    over = wanted[2] | wanted[3]
    if "final_obs" in infos and over.any():
        judge.compare("ends", infos["_final_obs"], over)
        compare_infos(judge, "final infos", infos["final_info"], other_infos["final_info"])
        for world in np.flatnonzero(over)[:4]:
            last = infos["final_obs"]
            one = {key: last[key][world] for key in last} if isinstance(last, dict) else last[world]
            judge.compare("final observations", one, other_infos["final_obs"][world])
    if env.metadata["autoreset_mode"].value == "Disabled" and over.any():
        first, second = (each.reset(options={"reset_mask": over})[0] for each in (env, other))
        judge.compare("observations of resets", first, second)


def compare_infos(judge: Judge, name: str, found: dict[str, Any], wanted: dict[str, Any]) -> None:
    """Compare all infos at once."""
    tensors, arrays = ([each[key] for key in INFO_FIELDS] for each in (found, wanted))
    judge.compare(name, torch.stack(tensors), np.stack(arrays))


def show_compared(device: str, effort: Effort) -> None:
    """Print whether games are equal, the most important ones first."""
    for label, game, keywords, part in COMPARED:
        compare(device, label, game, keywords, effort, part)
