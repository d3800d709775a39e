"""One trial of a search: a training that lasts as many processor seconds as all others.

A trial measures first how many decisions its settings allow in that time, and then trains so many.
So it is a run like any other: its schedules follow its decisions, its ``config.toml`` trains it
again, and `arkanoid reproduce` gets the same weights.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ...experiment.errors import SettingsError
from ...experiment.runs import INTERRUPTED, RunFolder
from ...experiment.seeds import Purpose, spread_seed
from ...experiment.settings import Experiment, load_experiment
from ..periodic_validation import SECONDS
from .space import SearchSpace
from .study import DECISIONS, JOURNAL

if TYPE_CHECKING:
    import optuna

PRUNED = "pruned"
SPENT = "processor time spent"
# Processor seconds, which are not counted, for measuring the speed: of the budget, and at most.
_TRYING = 0.05
_LONGEST = 5.0
# One core for each trial. What the command line or the space says comes later, and counts.
_ONE_CORE = [("training.torch_threads", "1"), ("env.threads", "1")]

# Gets a trial's number, the part of its time that is spent, and its latest measurement.
Progress = Callable[[int, float, float], None]


@dataclass(frozen=True)
class Search:
    """What all trials of a search have in common.

    Attributes:
        config: TOML file or packaged config.
        overrides: the settings of the command line.
        space: what is searched.
        folder: gets the study and the trials' runs.
        seed: from which the trials' seeds follow.
    """

    config: str
    overrides: tuple[tuple[str, str], ...]
    space: SearchSpace
    folder: Path
    seed: int

    def experiment(
        self, number: int, chosen: list[tuple[str, str]], decisions: int | None = None
    ) -> Experiment:
        """Return the experiment of a trial; ``decisions``: of its training, None: not known yet."""
        # No seed that anyone would choose: the best settings are trained anew with other ones.
        seed = spread_seed(self.seed, Purpose.TRIAL, number, bits=32)
        own = [("name", f"trial{number}"), ("output", str(self.folder)), ("seed", str(seed))]
        words = [*_ONE_CORE, *self.overrides, *chosen, *own]
        if decisions is not None:
            every = math.ceil(decisions / self.space.measurements)
            words += [("training.timesteps", str(decisions)), ("validation.every", str(every))]
        return load_experiment(self.config, words)


def run_trial(trial: "optuna.Trial", search: Search, progress: Progress) -> float:
    """Train one trial; return its last measurement.

    Raises:
        optuna.TrialPruned: it was stopped early, or its settings contradict each other.
        KeyboardInterrupt: Ctrl-C stopped it.
    """
    import optuna

    from ..training import train
    from .speed import measure_speed

    space = search.space
    chosen = _choose(trial, search)
    try:
        experiment = search.experiment(trial.number, chosen)
    except SettingsError as error:
        # Each value is legal, but not all together: a batch may not divide the rollout.
        trial.set_user_attr("refused", str(error))
        raise optuna.TrialPruned from None
    progress(trial.number, 0.0, math.nan)
    speed = measure_speed(experiment, min(_TRYING * space.budget, _LONGEST))
    rollout = experiment.ppo.n_steps * experiment.training.worlds
    decisions = rollout * max(1, round(speed * space.budget / rollout))
    judge = _Judge(trial, space, decisions, progress)
    experiment = search.experiment(trial.number, chosen, decisions)
    folder = RunFolder.create(experiment)
    outcome = train(experiment, folder, on_measure=judge, shows_progress=False)
    trial.set_user_attr(DECISIONS, decisions)
    trial.set_user_attr(SECONDS, round(judge.seconds, 2))
    if outcome == INTERRUPTED:
        raise KeyboardInterrupt
    if outcome == PRUNED:
        raise optuna.TrialPruned
    return judge.latest


def _choose(trial: "optuna.Trial", search: Search) -> list[tuple[str, str]]:
    """Return the settings that the sampler proposes for a trial."""
    try:
        return [pair for parameter in search.space.parameters for pair in parameter.suggest(trial)]
    except ValueError as error:
        raise SettingsError(
            f"{search.folder / JOURNAL}: the study searched another space ({error}): name another "
            f"--study"
        ) from None


class _Judge:
    """Reports a trial's measurements, and ends it early where others were better in that time.

    Attributes:
        latest: the latest measurement.
        seconds: of the processor, that the training had taken until then.
    """

    def __init__(
        self, trial: "optuna.Trial", space: SearchSpace, decisions: int, progress: Progress
    ) -> None:
        self.latest = -math.inf
        self.seconds = 0.0
        self._trial = trial
        self._space = space
        self._decisions = decisions
        self._progress = progress
        self._reported = 0

    def __call__(self, step: int, means: dict[str, float]) -> str | None:
        """Take a validation's means; return a reason to end the training, or None."""
        space = self._space
        self.latest, self.seconds = means[space.measure], means[SECONDS]
        part = self.seconds / space.budget
        # Trials are compared after equal times, not at equal numbers of measurements.
        self._reported = max(self._reported + 1, round(part * space.measurements))
        self._trial.report(self.latest, self._reported)
        self._progress(self._trial.number, min(1.0, part), self.latest)
        if step >= self._decisions:
            return None
        if self._trial.should_prune():
            return PRUNED
        # It has become slower than it was at first.
        return SPENT if part >= 1 else None
