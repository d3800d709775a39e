"""Measuring the policy in the course of its training: the best model, and when to stop."""

from collections.abc import Callable
from typing import Any

from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

from ..experiment.settings import Experiment
from ..experiment.worlds import make_worlds
from ..measure.episodes import MEASURES, play_episodes
from ..measure.suites import Start, find_starts
from .model import ModelPolicy

_LOGGED = tuple(name for name in MEASURES if name != "bricks_left")

# Takes the decision and the means of `MEASURES`, and may return a reason to end the training.
Judge = Callable[[int, dict[str, float]], str | None]


class Validation(BaseCallback):
    """Plays the validation's episodes now and then, and hands on each new best model.

    It draws no random number that the training would have drawn, and so changes no weight.

    Args:
        experiment: its ``[validation]`` says what is played and when.
        memory: what it remembers, here from a checkpoint; kept up to date in place.
        on_best: told of a model that is the best so far.
        stop: asked to end the training, with the reason.
        judge: told of each measurement, and may have a reason to end the training.
    """

    def __init__(
        self,
        experiment: Experiment,
        memory: dict[str, Any],
        on_best: Callable[[PPO], None],
        stop: Callable[[str], None],
        judge: Judge | None = None,
    ) -> None:
        super().__init__()
        self._experiment = experiment
        self._settings = experiment.validation
        self._memory = memory
        memory.setdefault("due", self._settings.every)
        memory.setdefault("best", None)
        memory.setdefault("worse", 0)
        self._on_best = on_best
        self._stop = stop
        self._judge = judge
        self._whole = not self._settings.levels
        self._starts = (
            (Start("whole games"),)
            if self._whole
            else find_starts(experiment, self._settings.levels)
        )
        self._worlds = make_worlds(experiment, len(self._starts) * self._settings.episodes)

    def _on_rollout_start(self) -> None:
        if self.model.num_timesteps >= self._memory["due"]:
            self.measure()

    def _on_step(self) -> bool:
        return True

    def measure(self) -> None:
        """Play, log, keep the model if it is the best, and ask for the end if it is time."""
        means = self._play()
        step = self.model.num_timesteps
        for name in _LOGGED:
            self.logger.record(f"validation/{name}", means[name])
        self.logger.dump(step)
        memory, settings = self._memory, self._settings
        memory["due"] = (step // settings.every + 1) * settings.every
        value, best = means[settings.best], memory["best"]
        memory["worse"] = 0 if best is None or value > best else memory["worse"] + 1
        # Of equals the latest: a rate that is at its end already has nothing more to tell.
        if best is None or value >= best:
            memory["best"] = value
            self._on_best(self.model)  # type: ignore[arg-type]
        reason = self._judge(step, means) if self._judge is not None else None
        if reason is not None:
            self._stop(reason)
        elif settings.stop_at and means["cleared"] >= settings.stop_at:
            self._stop(f"cleared rate {means['cleared']:.3f} reached at {step} decisions")
        elif settings.patience and memory["worse"] >= settings.patience:
            self._stop(f"{memory['worse']} measurements without a better one at {step} decisions")

    def _play(self) -> dict[str, float]:
        deterministic = self._experiment.evaluation.deterministic
        policy = ModelPolicy(self.model, deterministic, self._settings.seed)  # type: ignore[arg-type]
        self.model.policy.set_training_mode(False)
        played = play_episodes(
            self._worlds, policy, self._settings.seed, self._starts, whole=self._whole
        )
        return {name: float(values.mean()) for name, values in played.items()}

    def close(self) -> None:
        """Close the environment."""
        self._worlds.close()
