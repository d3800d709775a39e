"""Random play for tests."""

# Keywords of short games in which capsules, lost lives and the ends of episodes are frequent.
EVERYTHING = {"capsule_rate": 1.0, "lives": 2, "speed": 2.0, "max_decisions": 200}


def play(env, steps, seed=0):
    """Yield the observations of random play, of resets included."""
    yield env.reset(seed=seed)[0]
    env.action_space.seed(seed)
    for _ in range(steps):
        observation, _, terminated, truncated, _ = env.step(env.action_space.sample())
        yield observation
        if terminated or truncated:
            yield env.reset()[0]
