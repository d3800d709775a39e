"""Measuring the policy while it trains: which model is the best, and when to stop."""

import time
from collections.abc import Callable
from typing import Any

from gymnasium.spaces import Discrete
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

from ...envs.checks import counted
from ..experiment.seeds import Purpose, spread_seed, spread_seeds
from ..experiment.settings import Experiment
from ..experiment.worlds import make_worlds
from ..measure.episodes import MEASURES, play_episodes
from ..measure.policy import Policy
from ..measure.suites import WHOLE_GAMES, find_starts
from .collapse import Warn, Watched, stuck_warning
from .playing import ModelPolicy, device_beside, find_device

_LOGGED = tuple(name for name in MEASURES if name != "bricks_left")

# The processor seconds of the training so far, without its validation: in this process.
SECONDS = "processor_seconds"
# Takes the number of decisions, and the means of `MEASURES` and `SECONDS`; may return a reason to
# stop.
Judge = Callable[[int, dict[str, float]], str | None]


class PeriodicValidation(BaseCallback):
    """Plays the validation's episodes at regular times, and reports each new best model.

    It draws no random number that the training would draw, and so changes no weight.

    Args:
        experiment: its ``[validation]`` says what is played and when.
        state: this callback's, empty or from a checkpoint; it is changed in place.
        on_best: gets each model that is the best so far.
        stop: gets the reason when the training should end.
        judge: gets each measurement, and may return a reason to end the training.
        warn: gets a warning when the policy has collapsed on a level in two measurements.
    """

    def __init__(
        self,
        experiment: Experiment,
        state: dict[str, Any],
        on_best: Callable[[PPO], None],
        stop: Callable[[str], None],
        judge: Judge | None = None,
        warn: Warn = lambda message: None,
    ) -> None:
        super().__init__()
        self._experiment = experiment
        self._settings = experiment.validation
        self._state = state
        state.setdefault("due", self._settings.every)
        state.setdefault("best", None)
        state.setdefault("worse", 0)
        state.setdefault("latest", -1)
        self._on_best = on_best
        self._stop = stop
        self._judge = judge
        # When the training began; each measurement moves it on by its own time.
        self._began = time.process_time()
        self._warn = warn
        self._stuck: set[int] = set()
        self._told: set[int] = set()
        levels = self._settings.levels
        self._whole_games = not levels
        self._starts = find_starts(experiment, levels) if levels else (WHOLE_GAMES,)
        num_worlds = len(self._starts) * self._settings.episodes
        device = device_beside(find_device(experiment.training.device))
        self._worlds = make_worlds(experiment, num_worlds, experiment.game, device=device)

    def _on_training_start(self) -> None:
        self._began = time.process_time()

    def _on_rollout_start(self) -> None:
        if self.model.num_timesteps >= self._state["due"]:
            self.measure()

    def _on_step(self) -> bool:
        return True

    def finish(self) -> None:
        """Measure the policy at the end, unless the run was resumed there and has measured it."""
        if self.model.num_timesteps != self._state["latest"]:
            self.measure()

    def measure(self) -> None:
        """Play, log, report the model if it is the best, and ask for the end if it is time."""
        begun = time.process_time()
        means = self._play() | {SECONDS: begun - self._began}
        step = self.model.num_timesteps
        for name in _LOGGED:
            self.logger.record(f"validation/{name}", means[name])
        self.logger.dump(step)
        state, settings = self._state, self._settings
        state["latest"] = step
        state["due"] = (step // settings.every + 1) * settings.every
        value, best = means[settings.best], state["best"]
        state["worse"] = 0 if best is None or value > best else state["worse"] + 1
        # Of equals the latest: once a rate is 1, later models still improve, and it cannot tell.
        if best is None or value >= best:
            state["best"] = value
            self._on_best(self.model)  # type: ignore[arg-type]
        reason = self._judge(step, means) if self._judge is not None else None
        self._began += time.process_time() - begun
        if reason is not None:
            self._stop(reason)
        elif settings.stop_at and means["cleared"] >= settings.stop_at:
            self._stop(f"cleared rate {means['cleared']:.3f} reached at {step} decisions")
        elif settings.patience and state["worse"] >= settings.patience:
            worse = counted(state["worse"], "measurement")
            self._stop(f"{worse} without a better one at {step} decisions")

    def _play(self) -> dict[str, float]:
        deterministic = self._experiment.evaluation.deterministic
        settings = self._settings
        seed = spread_seed(settings.seed, Purpose.VALIDATION_POLICY)
        policy: Policy = ModelPolicy(self.model, deterministic, seed)  # type: ignore[arg-type]
        watched = None
        if isinstance(self.model.action_space, Discrete) and not self._whole_games:
            policy = watched = Watched(policy, self.model, self._worlds.num_envs)
        self.model.policy.set_training_mode(False)
        seeds = spread_seeds(settings.seed, Purpose.VALIDATION, settings.episodes)
        played = play_episodes(
            self._worlds, policy, seeds, self._starts, whole_games=self._whole_games
        )
        if watched is not None:
            self._tell_stuck(set(watched.stuck(played["cleared"])))
        return {name: float(values.mean()) for name, values in played.items()}

    def _tell_stuck(self, stuck: set[int]) -> None:
        """Warn, once, of levels on which the policy is stuck, and was in the last measurement."""
        new = sorted((stuck & self._stuck) - self._told)
        self._stuck = stuck
        self._told |= set(new)
        if new:
            names = [self._starts[level].name for level in new]
            self._warn(stuck_warning(names, self.model.num_timesteps))

    def close(self) -> None:
        """Close the environment."""
        self._worlds.close()
