"""With the changes of `docs/extending.md`: a reward for bricks pays for bricks."""

import gymnasium as gym

env = gym.make("arkanoid:Arkanoid-v0", reward="bricks")
env.reset(seed=0)
total = 0.0
for _ in range(1000):
    _, reward, terminated, truncated, info = env.step(env.action_space.sample())
    assert reward == info["bricks_broken"]
    total += float(reward)
    if terminated or truncated:
        env.reset()
assert total > 0
