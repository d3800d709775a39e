"""The curriculum: how episodes begin in each stage of a training."""

from typing import Any

import numpy as np
from stable_baselines3.common.callbacks import BaseCallback

from ..adapter import GymnasiumVecEnv
from ..experiment.settings import Curriculum, Experiment


class Stages(BaseCallback):
    """Begins each stage of the curriculum at its time, with a new episode in every world.

    Args:
        experiment: its ``[curriculum]`` has the stages.
        venv: the environment that is trained on.
        state: this callback's, empty or from a checkpoint; it is changed in place.
    """

    def __init__(
        self, experiment: Experiment, venv: GymnasiumVecEnv, state: dict[str, Any]
    ) -> None:
        super().__init__()
        self._curriculum = experiment.curriculum
        self._timesteps = experiment.training.timesteps
        self._venv = venv
        self._state = state
        state.setdefault("stage", 0)

    @property
    def _stage(self) -> int:
        return int(self._state["stage"])

    def options(self) -> list[dict[str, Any]]:
        """Return the options for `reset` of each world in the present stage."""
        return stage_options(self._curriculum, self._stage, self._venv.num_envs)

    def _on_rollout_start(self) -> None:
        stage = stage_at(self._curriculum, self.model.num_timesteps / self._timesteps)
        if stage == self._stage:
            return
        self._state["stage"] = stage
        self._venv.set_options(self.options())
        model: Any = self.model
        # The model may have wrapped our environment in its own.
        model._last_obs = model.env.reset()
        model._last_episode_starts = np.ones(self._venv.num_envs, np.bool_)

    def _on_step(self) -> bool:
        return True


def stage_at(curriculum: Curriculum, part: float) -> int:
    """Return the index of the stage after a part of the training."""
    return sum(part >= begins for begins in curriculum.stages)


def stage_options(curriculum: Curriculum, stage: int, num_worlds: int) -> list[dict[str, Any]]:
    """Return the options for `reset` of each world in a stage."""
    options: list[dict[str, Any]] = [{} for _ in range(num_worlds)]
    for world, of_world in enumerate(options):
        if curriculum.difficulty:
            of_world["difficulty"] = curriculum.difficulty[stage] * (world + 1) / num_worlds
        if curriculum.rounds:
            of_world["level"] = 1 + world % curriculum.rounds[stage]
    return options
