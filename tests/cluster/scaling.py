"""How many decisions per second one and two runners play, and the bare environment."""

import os
import time
from typing import Any

import gymnasium as gym
import numpy as np
from rllib_ppo import make_config

WORLDS = 64  # of each runner
DECISIONS = 200_000  # of the bare environment, per measurement
SAMPLED = 20_000  # decisions of each runner, per measurement
REPEATS = 3
ITERATIONS = 5


def measure_scaling() -> str:
    """Return a table of decisions per second, by the wall clock and by processor time.

    Other programs hardly affect processor time. A training has two rows, because the runners share
    their work, and the learner does not share its own.
    """
    rows = [("bare environment, random actions", *_bare())]
    for runners in (1, 2):
        name = f"RLlib, {runners} runner{'s' * (runners > 1)}"
        algorithm = make_config(runners, WORLDS, seed=0).build_algo()
        try:
            rows.append((f"{name}, playing only", *_sampling(algorithm)))
            rows.append((f"{name}, training (work: the learner's)", *_training(algorithm)))
        finally:
            algorithm.stop()
    head = f"{WORLDS} worlds a runner, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"
    lines = [f"{head:50}{'by the clock':>14}{'a second of work':>19}"]
    lines += [f"{name:50}{clock:14,.0f}{work:19,.0f}" for name, clock, work in rows]
    return "\n".join(lines)


def _bare() -> tuple[float, float]:
    worlds = gym.make_vec("arkanoid:ArkanoidLite-v0", num_envs=WORLDS, threads=1)
    worlds.action_space.seed(0)
    actions = [worlds.action_space.sample() for _ in range(100)]
    worlds.reset(seed=0)
    speeds = []
    for _ in range(REPEATS):
        start, busy = time.perf_counter(), time.process_time()
        for step in range(DECISIONS // WORLDS):
            worlds.step(actions[step % len(actions)])
        speeds.append(_speeds(DECISIONS, time.perf_counter() - start, time.process_time() - busy))
    worlds.close()
    return _median(speeds)


def _sampling(algorithm: Any) -> tuple[float, float]:
    """Let all runners play at the same time, without learning."""
    group = algorithm.env_runner_group
    group.foreach_env_runner(_play(20 * WORLDS), local_env_runner=False)  # loads kernels
    speeds = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        players = group.foreach_env_runner(_play(SAMPLED), local_env_runner=False)
        seconds = time.perf_counter() - start
        played = sum(decisions for decisions, _ in players)
        speeds.append(_speeds(played, seconds, sum(busy for _, busy in players)))
    return _median(speeds)


def _play(decisions: int) -> Any:
    """Return a function that plays in a runner; it returns the decisions and processor time."""

    def play(runner: Any) -> tuple[int, float]:
        busy = time.process_time()
        episodes = runner.sample(num_timesteps=decisions)
        return sum(len(episode) for episode in episodes), time.process_time() - busy

    return play


def _training(algorithm: Any) -> tuple[float, float]:
    """Train; measure whole iterations by the clock, and the processor time of the learner."""
    algorithm.train()
    start, busy, played = time.perf_counter(), time.process_time(), 0.0
    for _ in range(ITERATIONS):
        played += algorithm.train()["env_runners"]["num_env_steps_sampled"]
    return _speeds(played, time.perf_counter() - start, time.process_time() - busy)


def _speeds(decisions: float, clock: float, busy: float) -> tuple[float, float]:
    """Return decisions per second of wall-clock time and of processor time."""
    return decisions / clock, decisions / busy


def _median(speeds: list[tuple[float, float]]) -> tuple[float, float]:
    clock, core = np.median(speeds, axis=0)
    return float(clock), float(core)
