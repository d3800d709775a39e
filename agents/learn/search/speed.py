"""How fast an experiment trains, measured by training a little."""

import time

from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import Logger

from ...experiment.settings import Experiment
from ...experiment.worlds import make_worlds
from ...measure.episodes import adapt
from ..levels.sampling import make_stages
from ..model import make_model
from ..playing import worlds_device

_ENDLESS = 10**15  # decisions


def measure_speed(experiment: Experiment, seconds: float) -> float:
    """Return how many decisions a processor second of the experiment's training allows.

    It trains for about ``seconds``, at least one rollout with its update, after another one in
    which everything is loaded. Nothing is kept of it.
    """
    device = worlds_device(experiment)
    venv = adapt(make_worlds(experiment, experiment.training.worlds, device=device))
    try:
        model = make_model(experiment, venv)
        model.set_logger(Logger(None, []))
        stages = make_stages(experiment, venv, {})
        venv.set_options(stages.options())
        watch = _Stopwatch(seconds)
        model.learn(_ENDLESS, callback=[stages, watch])
        return watch.speed
    finally:
        venv.close()


class _Stopwatch(BaseCallback):
    """Measures from the second rollout on, and ends the training after so many seconds."""

    def __init__(self, seconds: float) -> None:
        super().__init__()
        self._seconds = seconds
        self._begun: tuple[float, int] | None = None
        self._rollouts = 0
        self.speed = 0.0

    def _on_rollout_start(self) -> None:
        now, decisions = time.process_time(), self.model.num_timesteps
        self._rollouts += 1
        if self._rollouts == 2:
            self._begun = now, decisions
        elif self._begun is not None and now - self._begun[0] >= self._seconds:
            self.speed = (decisions - self._begun[1]) / (now - self._begun[0])

    def _on_step(self) -> bool:
        return not self.speed
