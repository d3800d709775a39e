"""Are RLlib's episodes the game's, and does it measure an agent as our own evaluation does?"""

from collections import Counter, defaultdict
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
import torch
from arkanoid.agents.measure.episodes import play_episodes
from arkanoid.agents.measure.policy import Policy
from ray.rllib.core.rl_module.rl_module import RLModule
from ray.rllib.env.single_agent_env_runner import SingleAgentEnvRunner
from rllib_ppo import make_config, make_worlds

WORLDS = 12
SEED = 7
# Short games, of which some are truncated.
SHORT = {"lives": 1, "max_decisions": 60}
# The calls of `sample`, each of which cuts the episodes, and each world's decisions per call.
CHUNKS, CHUNK = 8, 64


def check_episodes() -> str:
    """Play with a runner as a training does, and replay each world in a single environment.

    Observations, rewards and ends must be the same, bit for bit. This finds a step too many or too
    few at an episode's end (the autoreset mode), and observations that the next step overwrites
    (`copy`).
    """
    runner, owners = _runner()
    chunks = defaultdict(list)
    for _ in range(CHUNKS):
        for chunk in runner.sample(num_timesteps=CHUNK * WORLDS):
            chunks[chunk.id_].append(chunk)
    metrics = runner.get_metrics()
    reported = [metrics[name].peek() for name in ("episode_return_mean", "episode_len_mean")]
    runner.stop()
    games: list[Game] = []
    for world, seed in enumerate(_seeds()):
        games += _replay(seed, [chunks[name] for name, owner in owners.items() if owner == world])
    ends = Counter(game.end for game in games)
    assert {"terminated", "truncated"} <= ends.keys(), "both kinds of ends must occur"
    ended = [game for game in games if game.end]
    expected = np.mean([(game.total, game.length) for game in ended], axis=0)
    np.testing.assert_allclose(reported, expected, rtol=1e-12)  # RLlib sums in another order
    return (
        f"{len(ended)} episodes ({ends['truncated']} truncated) are bit for bit those of single "
        f"environments;\nRLlib's mean return {reported[0]:.3f} "
        f"and length {reported[1]:.1f} are theirs"
    )


class Game(NamedTuple):
    """An episode, as a single environment plays it."""

    total: float
    length: int
    end: str  # "terminated", "truncated", or nothing yet


def _runner() -> tuple[SingleAgentEnvRunner, dict[str, int]]:
    """Return a runner in this process, and the world of each episode, filled as it plays."""
    owners: dict[str, int] = {}

    def remember(*, episode: Any, env_index: int, **others: Any) -> None:
        owners[episode.id_] = env_index

    config = make_config(0, WORLDS, SEED, **SHORT).reporting(
        metrics_num_episodes_for_smoothing=10**6  # the mean is over all of them
    )
    return SingleAgentEnvRunner(config=config.callbacks(on_episode_start=remember)), owners


def _replay(seed: int, episodes: list[list[Any]]) -> list[Game]:
    """Replay a world's episodes, each given as a list of RLlib's chunks, and compare them."""
    env = gym.make("arkanoid:ArkanoidLite-v0", life_penalty=0.2, **SHORT)
    observation, _ = env.reset(seed=seed)
    games = []
    for chunks in episodes:
        rewards: list[float] = []
        end = ""
        for chunk in chunks:
            for step, action in enumerate(chunk.get_actions()):
                assert not end, "RLlib played on in an episode that was over"
                np.testing.assert_array_equal(chunk.get_observations(step), observation)
                observation, reward, terminated, truncated, _ = env.step(action)
                assert chunk.get_rewards(step) == reward
                rewards.append(float(reward))
                end = "terminated" if terminated else "truncated" if truncated else ""
            np.testing.assert_array_equal(chunk.get_observations(-1), observation)
            assert chunk.is_terminated == (end == "terminated")
            assert chunk.is_truncated == (end == "truncated")
        games.append(Game(sum(rewards), len(rewards), end))
        if end:
            observation, _ = env.reset()
    env.close()
    return games


def _seeds() -> list[int]:
    """Return the seeds that a runner in this process gives its worlds."""
    seen: list[int] = []

    class Spy(gym.vector.VectorWrapper):
        def reset(self, *, seed: Any = None, options: Any = None) -> Any:
            seen.extend(seed)
            return super().reset(seed=seed, options=options)

    worlds = make_worlds({"id": "arkanoid:ArkanoidLite-v0", "num_envs": WORLDS})
    worlds.env = Spy(worlds.env)
    worlds.reset(seed=SEED)
    worlds.close()
    return seen


def check_seeds() -> str:
    """Check that no two worlds of neighbouring runners have the same random numbers."""
    # An episode's level is drawn at random; at this difficulty hardly any two levels are alike.
    levels = {"levels": "seeds:0-999999999", "difficulty": 1.0}
    fields = []
    for runner in range(4):
        worlds = make_worlds({"id": "arkanoid:ArkanoidLite-v0", "num_envs": 64} | levels)
        observations, _ = worlds.reset(seed=SEED + runner)
        fields.append(observations)
        worlds.close()
    distinct = len(np.unique(np.concatenate(fields), axis=0))
    assert distinct == 4 * 64
    return f"the first levels of 4 runners' 64 worlds are {distinct} different ones"


def likeliest(module: RLModule, count: int) -> Policy:
    """Return a module's policy without exploration, for `play_episodes` with `count` worlds.

    It always computes all worlds, as RLlib does: the rounding of a matrix product depends on the
    number of rows, and one different decision makes a different game.
    """
    inputs: Any = None

    def policy(observations: Any, worlds: Any) -> Any:
        nonlocal inputs
        if inputs is None:
            inputs = np.zeros((count, observations.shape[1]), np.float32)
        inputs[worlds] = observations
        with torch.no_grad():
            outputs = module.forward_inference({"obs": torch.from_numpy(inputs)})
        return outputs["action_dist_inputs"].argmax(1).numpy()[worlds]

    return policy


def check_evaluation(module: RLModule) -> str:
    """Let RLlib and our own evaluation measure the same policy on the same seeds."""
    count = 32
    keywords = {"life_penalty": 0.2, "max_decisions": 2000}
    worlds = gym.make_vec(
        "arkanoid:ArkanoidLite-v0", num_envs=count, autoreset_mode="SameStep", **keywords
    )
    ours = play_episodes(worlds, likeliest(module, count), range(SEED, SEED + count))
    worlds.close()
    theirs = _first_episodes(module, count, keywords)
    for name in ("return", "steps"):
        np.testing.assert_allclose(theirs[name], ours[name].ravel(), rtol=1e-12)
    return (
        f"one policy, {count} games: mean return {np.mean(theirs['return']):.3f}, length "
        f"{np.mean(theirs['steps']):.1f} by RLlib's episodes,\n{ours['return'].mean():.3f} and "
        f"{ours['steps'].mean():.1f} by our evaluation; each game alone, too"
    )


def _first_episodes(
    module: RLModule, count: int, keywords: dict[str, Any]
) -> dict[str, list[float]]:
    """Return each world's first episode, played by RLlib, without the wrapper for seeds."""
    first: dict[int, str] = {}

    def remember(*, episode: Any, env_index: int, **others: Any) -> None:
        first.setdefault(env_index, episode.id_)

    config = make_config(0, count, SEED).environment(
        "arkanoid:ArkanoidLite-v0", env_config=keywords
    )
    # RLlib would merge these settings into the earlier ones.
    config.env_config = keywords
    runner = SingleAgentEnvRunner(config=config.callbacks(on_episode_start=remember))
    runner.module.set_state(module.get_state())
    totals: dict[str, list[float]] = defaultdict(lambda: [0.0, 0.0])
    over: set[str] = set()
    while len(first) < count or not set(first.values()) <= over:
        for chunk in runner.sample(num_timesteps=64 * count, explore=False):
            totals[chunk.id_][0] += chunk.get_return()
            totals[chunk.id_][1] += len(chunk)
            if chunk.is_done:
                over.add(chunk.id_)
    runner.stop()
    games = [totals[first[world]] for world in range(count)]
    return {"return": [game[0] for game in games], "steps": [game[1] for game in games]}
