"""Measures what share of a training the environment costs, by PPO on a free environment.

Run: python tests/benchmarks/training.py [--config quick] [--rollouts 12]
"""

import argparse
import time
from typing import Any

import numpy as np
from arkanoid.agents.experiment.settings import Experiment, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.learn.model import make_model
from arkanoid.agents.measure.episodes import adapt
from stable_baselines3.common.vec_env import VecEnv

REPEATS = 3


class Free(VecEnv):
    """Has the game's spaces, and gives the same answer to every action."""

    def __init__(self, venv: VecEnv) -> None:
        super().__init__(venv.num_envs, venv.observation_space, venv.action_space)
        self._layout = venv.get_attr("layout", 0)
        self._observations: Any = np.array(venv.reset())
        self._rewards = np.zeros(venv.num_envs, np.float32)
        self._dones = np.zeros(venv.num_envs, bool)
        self._infos: list[dict[str, Any]] = [{} for _ in range(venv.num_envs)]

    def reset(self) -> Any:
        return self._observations

    def step_async(self, actions: Any) -> None:
        pass

    def step_wait(self) -> Any:
        return self._observations, self._rewards, self._dones, self._infos

    def close(self) -> None:
        pass

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return self._layout if attr_name == "layout" else [None] * self.num_envs

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        raise NotImplementedError

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **kwargs: Any) -> Any:
        raise NotImplementedError

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        return [False] * self.num_envs


def seconds_of(experiment: Experiment, venv: VecEnv, rollouts: int) -> tuple[float, float]:
    """Return the seconds of a training after a warm-up, and of its updates alone."""
    model = make_model(experiment, venv)
    size = experiment.ppo.n_steps * experiment.training.worlds
    update, spent = model.train, [0.0]

    def timed() -> None:
        start = time.process_time()
        update()
        spent[0] += time.process_time() - start

    model.train = timed  # type: ignore[method-assign]
    model.learn(size)
    spent[0], start = 0.0, time.process_time()
    model.learn(size * rollouts)
    return time.process_time() - start, spent[0]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--config", default="quick", help="packaged config or TOML file")
    parser.add_argument("--rollouts", type=int, default=12, help="rollouts per measurement")
    options = parser.parse_args()
    experiment = load_experiment(options.config, [("training.torch_threads", "1")])
    game = adapt(make_worlds(experiment, experiment.training.worlds))
    decisions = experiment.ppo.n_steps * experiment.training.worlds * options.rollouts
    shares = []
    print(f"{options.config}: {decisions:,} decisions, processor time of one thread\n")
    print(f"{'':10}{'game':>12}{'free':>12}{'game costs':>14}{'updates':>12}{'the rest':>12}")
    for repeat in range(REPEATS):
        played, updates = seconds_of(experiment, game, options.rollouts)
        free, _ = seconds_of(experiment, Free(game), options.rollouts)
        shares.append(1.0 - free / played)
        rest = 1.0 - shares[-1] - updates / played
        print(
            f"{repeat + 1:<10}{played:10.2f} s{free:10.2f} s{shares[-1]:14.1%}"
            f"{updates / played:12.1%}{rest:12.1%}"
        )
    share = float(np.median(shares))
    verdict = "met" if share <= 0.15 else "MISSED"
    print(
        f"\nenvironment and adapter: {share:.1%} of the training (goal: at most 15 %, {verdict});"
    )
    print("the rest is the policy's forward pass and what stable-baselines3 does between steps")
    game.close()


if __name__ == "__main__":
    main()
