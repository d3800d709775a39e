"""Other packages' games of Breakout, where they can be imported."""

import itertools
import os
from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np

from .measuring import ACTIONS, Effort, player, rate, say


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
    ("gymnax: MinAtar's Breakout", measure_gymnax, (4096, 65536)),
    ("turbo-native: pictures, all cores", measure_turbo, (1024,)),
    ("PufferLib: Breakout, one core", measure_puffer, (4096,)),
]


def show_peers(effort: Effort) -> None:
    """Print the rows of peers, or why one is left out."""
    for name, measure, counts in PEERS:
        for count in dict.fromkeys(min(count, effort.most_worlds) for count in counts):
            label = f"{name}, {count:,} worlds"
            try:
                say(label, f"{measure(count, effort):14,.0f}")
            except Exception as error:  # whatever a peer does not like here
                say(label, f"{'left out':>14}")
                print(f"    {type(error).__name__}: {error}"[:79], flush=True)
