"""Compares games on a graphics card with this processor's, in bits and in speed, and with peers.

Run: python tests/benchmarks/gpu.py [--device cpu] [--quick]

First, both play the same decisions and every number is compared. Then it measures decisions per
second, with random actions that are drawn before, after the games have drifted apart. A ratio says
how many times as fast a row is as the same games on all cores. Peers take part where they can be
imported. A card takes about four minutes.
"""

import argparse
import itertools
import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

import arkanoid  # noqa: F401
import gymnasium as gym
import numpy as np
import torch
from arkanoid.envs.state import INFO_FIELDS

LITE, FULL = "ArkanoidLite-v0", "Arkanoid-v0"
GREY = {"observation": "rgb", "grey": True}
# Decisions of which each step is compared, with all that the games have to offer.
FEATURES = {"landing": True, "life_penalty": 1.0, "levels": "train", "lives": 1}
# Label, id, keywords, the numbers of worlds.
KINDS: list[tuple[str, str, dict[str, Any], tuple[int, ...]]] = [
    ("lite, vector", LITE, {}, (4096, 16384, 65536, 262144, 1048576)),
    ("lite, landing", LITE, {"landing": True}, (65536, 262144)),
    ("full, vector", FULL, {}, (4096, 65536, 262144)),
    ("full, grid", FULL, {"observation": "grid"}, (32768,)),
    ("lite, picture", LITE, GREY | {"stack": 1}, (4096, 32768)),
    ("lite, stack of 4 pictures", LITE, GREY | {"stack": 4}, (4096, 32768)),
]
ACTIONS = 64  # steps until the actions repeat
LABEL = 56  # characters


@dataclass(frozen=True)
class Effort:
    """How much is compared and measured."""

    worlds: int  # of the comparison
    decisions: int  # of each world there, at most
    patience: float  # seconds for each game's comparison
    warm_up: int  # decisions
    turn: float  # seconds
    most_worlds: int


THOROUGH = Effort(4096, 100_000, 35.0, warm_up=100, turn=1.0, most_worlds=1 << 20)
QUICK = Effort(16, 20, 5.0, warm_up=2, turn=0.02, most_worlds=32)


def make(device: str | None, game: str, worlds: int, **keywords: Any) -> Any:
    """Return worlds as tensors on a device; with None, as arrays, played by all cores."""
    place = {"threads": os.cpu_count()} if device is None else {"device": device}
    return gym.make_vec(
        f"arkanoid:{game}",
        worlds,
        vectorization_mode="vector_entry_point",
        autoreset_mode="SameStep",
        copy=False,
        **(place | keywords),
    )


def say(label: str, text: str) -> None:
    """Print a row."""
    print(f"  {label:{LABEL}}{text}", flush=True)


def compare(device: str, game: str, effort: Effort) -> None:
    """Play the same decisions in both ways, and say in how many anything was different."""
    env, other = (make(place, game, effort.worlds, **FEATURES) for place in (device, None))
    same = torch.ones((), dtype=torch.bool, device=device)
    seen, expected = env.reset(seed=1)[0], other.reset(seed=1)[0]
    random = np.random.default_rng(0)
    begin, played = time.perf_counter(), 0
    while played < effort.decisions and time.perf_counter() - begin < effort.patience:
        actions = random.integers(0, env.single_action_space.n, effort.worlds)
        *found, infos = env.step(actions)
        *wanted, other_infos = other.step(actions)
        pairs = [*zip(found, wanted, strict=True)]
        pairs += [(infos[key], other_infos[key]) for key in INFO_FIELDS]
        for tensor, array in pairs:
            bits = torch.from_numpy(np.ascontiguousarray(array)).to(device)
            same &= (tensor == bits).all()
        played += 1
    whole = bool(same) and env.snapshot() == other.snapshot()
    assert seen.shape == expected.shape
    decisions = played * effort.worlds
    say(
        f"{game}, {effort.worlds:,} worlds, landing, life_penalty, levels",
        f"{decisions:14,} decisions: {'equal' if whole else 'DIFFERENT'}",
    )
    env.close()
    other.close()


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


def measure_ours(
    device: str | None, game: str, worlds: int, keywords: dict[str, Any], effort: Effort
) -> float:
    """Return the decisions per second of a kind of games."""
    env = make(device, game, worlds, **keywords)
    env.reset(seed=0)
    drawn = np.random.default_rng(0).integers(0, env.single_action_space.n, (ACTIONS, worlds))
    actions = list(drawn) if device is None else list(torch.from_numpy(drawn).to(device))
    wait = torch.cuda.synchronize if str(device).startswith("cuda") else lambda: None
    found = rate(player(env, itertools.cycle(actions)), worlds, effort, wait)
    env.close()
    return found


def measure_gymnax(worlds: int, effort: Effort) -> float:
    """Return the decisions per second of MinAtar's Breakout on JAX, in a compiled loop."""
    import gymnax
    import jax

    env, params = gymnax.make("Breakout-MinAtar")
    length = 50
    step = jax.vmap(env.step, (0, 0, 0, None))

    @jax.jit
    def play_some(key: Any, states: Any) -> Any:
        def once(carry: Any, _: Any) -> Any:
            key, states = carry
            key, draw, chance = jax.random.split(key, 3)
            actions = jax.random.randint(draw, (worlds,), 0, 3)
            result = step(jax.random.split(chance, worlds), states, actions, params)
            seen, states, reward = result[:3]
            return (key, states), (reward.sum(), seen.sum())

        return jax.lax.scan(once, (key, states), None, length)

    key = jax.random.key(0)
    states = jax.vmap(env.reset, (0, None))(jax.random.split(key, worlds), params)[1]
    carry = [(key, states)]

    def play(steps: int) -> None:
        for _ in range(steps):
            carry[0], _ = play_some(*carry[0])

    return length * rate(play, worlds, effort, lambda: jax.block_until_ready(carry[0]))


def measure_turbo(worlds: int, effort: Effort) -> float:
    """Return the decisions per second of a native Breakout, as pictures, on all cores."""
    import env_breakoutatari2600_turbo_native as turbo

    env = gym.make_vec(
        turbo.GYMNASIUM_ENV_ID,
        worlds,
        "vector_entry_point",
        game="Breakout-Atari2600-v0",
        num_threads=os.cpu_count(),
        frame_stack=1,
        obs_copy="unsafe_view",
    )
    env.reset(seed=0)
    random = np.random.default_rng(0)
    actions = list(random.integers(0, env.single_action_space.n, (ACTIONS, worlds)))

    def play(steps: int) -> None:
        for index in range(steps):
            _, _, terminated, truncated, _ = env.step(actions[index % ACTIONS])
            if (terminated | truncated).any():
                env.reset(options={"reset_mask": terminated | truncated})

    found = rate(play, worlds, effort, lambda: None)
    env.close()
    return found


def measure_puffer(worlds: int, effort: Effort) -> float:
    """Return the decisions per second of PufferLib's Breakout, on one core."""
    from pufferlib.ocean.breakout import breakout

    env = breakout.Breakout(num_envs=worlds)
    env.reset(seed=0)
    drawn = np.random.default_rng(0).integers(0, env.single_action_space.n, (ACTIONS, worlds))
    return rate(player(env, itertools.cycle(list(drawn))), worlds, effort, lambda: None)


PEERS: list[tuple[str, Callable[[int, Effort], float], tuple[int, ...]]] = [
    ("gymnax: MinAtar's Breakout, 10 x 10 x 4", measure_gymnax, (4096, 65536)),
    ("turbo-native: Breakout, a picture, all cores", measure_turbo, (1024,)),
    ("PufferLib: Breakout, vector, one core", measure_puffer, (4096,)),
]


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
                say(label, f"left out: {error}")
                continue
            say(label, f"{found:14,.0f}{found / cores:9.2f} x")


def show_peers(effort: Effort) -> None:
    """Print the rows of peers, or why one is left out."""
    for name, measure, counts in PEERS:
        for count in dict.fromkeys(min(count, effort.most_worlds) for count in counts):
            label = f"{name}, {count:,} worlds"
            try:
                say(label, f"{measure(count, effort):14,.0f}")
            except Exception as error:  # whatever a peer does not like here
                say(label, f"left out: {type(error).__name__}: {str(error)[:80]}")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--device", help="of torch; a card if there is one, or else left out")
    parser.add_argument("--quick", action="store_true", help="try it out; the figures mean nothing")
    parser.add_argument("--no-peers", action="store_true", help="leave out other packages")
    options = parser.parse_args()
    # JAX would take most of the card's memory for itself.
    os.environ.setdefault("XLA_PYTHON_CLIENT_PREALLOCATE", "false")
    effort = QUICK if options.quick else THOROUGH
    device = options.device or ("cuda" if torch.cuda.is_available() else None)
    if device is None:
        print("no graphics card: --device cpu --quick tries out what a card would do")
        return
    card = torch.cuda.get_device_name() if device.startswith("cuda") else "this processor"
    begin = time.perf_counter()
    print(f"{card}, torch {torch.__version__}, {os.cpu_count()} cores, numba {version('numba')}")
    print("The same decisions on the device and on the processor:")
    for game in (LITE, FULL):
        compare(device, game, effort)
    print("Decisions per second (x: times all cores with the same observations):")
    show_ours(device, effort)
    if not options.no_peers:
        print("Peers, decisions per second:")
        show_peers(effort)
    print(f"{time.perf_counter() - begin:.0f} s")


if __name__ == "__main__":
    main()
