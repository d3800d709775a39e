"""How the parts of the benchmark measure, and what they print."""

import itertools
import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import arkanoid  # noqa: F401
import gymnasium as gym
import torch

ACTIONS = 64  # steps until the actions repeat
LABEL = 50  # characters
GREY = {"observation": "rgb", "grey": True}


@dataclass(frozen=True)
class Effort:
    """How much is compared and measured."""

    worlds: int  # of the comparison
    decisions: int  # of each world there, at most
    patience: float  # seconds for each game's comparison
    warm_up: int  # decisions
    turn: float  # seconds
    most_worlds: int
    training: int  # decisions are divided by this


THOROUGH = Effort(4096, 100_000, 15.0, warm_up=100, turn=1.0, most_worlds=1 << 20, training=1)
QUICK = Effort(16, 20, 50.0, warm_up=2, turn=0.02, most_worlds=32, training=20_000)


def make(device: str | None, game: str, worlds: int, **keywords: Any) -> Any:
    """Return worlds as tensors on a device; with None, as arrays, played by all cores."""
    place = {"threads": os.cpu_count()} if device is None else {"device": device}
    return gym.make_vec(
        f"arkanoid:{game}",
        worlds,
        vectorization_mode="vector_entry_point",
        **({"copy": False, "autoreset_mode": "SameStep"} | place | keywords),
    )


def say(label: str, text: str) -> None:
    """Print a row."""
    print(f"  {label:{LABEL}}{text}", flush=True)


def verdict(effort: Effort, goal: str, met: bool) -> None:
    """Print whether a goal is met."""
    told = "met" if met else "MISSED"
    print(f"    goal {goal}: {told if effort.training == 1 else 'not tried'}", flush=True)


def rate(
    play: Callable[[int], None], worlds: int, effort: Effort, wait: Callable[[], None]
) -> float:
    """Return decisions per second of what plays so many steps."""
    play(effort.warm_up)
    wait()
    steps = 1
    while True:
        begin = time.perf_counter()
        play(steps)
        wait()
        seconds = time.perf_counter() - begin
        if seconds >= effort.turn:
            return steps * worlds / seconds
        steps = max(2 * steps, int(1.2 * steps * effort.turn / max(seconds, 1e-6)))


def player(env: Any, actions: Iterator[Any]) -> Callable[[int], None]:
    """Return what plays steps in a vector environment."""

    def play(steps: int) -> None:
        for chosen in itertools.islice(actions, steps):
            env.step(chosen)

    return play


def waiting(device: str | None) -> Callable[[], None]:
    """Return what waits until a device has done all."""
    return torch.cuda.synchronize if str(device).startswith("cuda") else lambda: None
