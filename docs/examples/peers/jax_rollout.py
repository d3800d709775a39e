"""JAX: the native batch in a compiled loop, by `io_callback` within `lax.scan`.

The games run on the processor, and the loop calls them in order; the policy is compiled.
"""

import gymnasium as gym
import jax
import jax.numpy as jnp
import numpy as np
from jax.experimental import io_callback

WORLDS, STEPS = 64, 100


def main() -> None:
    """Play at random, by a linear policy, in one compiled function."""
    worlds = gym.make_vec(
        "arkanoid:ArkanoidLite-v0",
        WORLDS,
        vectorization_mode="vector_entry_point",
        autoreset_mode="SameStep",
    )
    actions = int(worlds.single_action_space.n)
    shapes = (
        jax.ShapeDtypeStruct(worlds.observation_space.shape, jnp.float32),
        jax.ShapeDtypeStruct((WORLDS,), jnp.float32),
        jax.ShapeDtypeStruct((WORLDS,), jnp.bool_),
    )

    def step(action: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        seen, reward, terminated, truncated, _ = worlds.step(np.asarray(action))
        return seen, reward.astype(np.float32), terminated | truncated

    @jax.jit
    def play(weights: jax.Array, seen: jax.Array, key: jax.Array) -> tuple[jax.Array, ...]:
        def turn(seen: jax.Array, key: jax.Array) -> tuple[jax.Array, tuple[jax.Array, ...]]:
            action = jax.random.categorical(key, seen @ weights)
            seen, reward, done = io_callback(step, shapes, action, ordered=True)
            return seen, (reward, done)

        return jax.lax.scan(turn, seen, jax.random.split(key, STEPS))[1]

    key = jax.random.key(0)
    weights = jax.random.normal(key, (worlds.single_observation_space.shape[0], actions)) / 10
    seen, _ = worlds.reset(seed=0)
    rewards, done = play(weights, jnp.asarray(seen), key)
    assert rewards.shape == (STEPS, WORLDS)
    print(f"played: {rewards.size} steps, {int(done.sum())} episodes, reward {rewards.sum():.2f}")


if __name__ == "__main__":
    main()
