"""A search for hyper-parameters: the search space, and how trials are trained and judged."""

import errno
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tomli_w

from ...envs.config import Config
from ...envs.hints import BATCH_KEYWORDS, keyword_hint
from ..experiment.errors import SettingsError
from ..experiment.files import cause
from ..experiment.reading import check_value, read_toml
from ..experiment.runs import RunFolder
from ..experiment.seeds import Purpose, spread_seed
from ..experiment.settings import BEST, Experiment, load_experiment

if TYPE_CHECKING:
    import optuna

_JOURNAL = "study.journal"
_BOUNDS = ("low", "high", "log", "step")
_MOST = 2**53  # of a bound: so all integers below are floats, too


@dataclass(frozen=True)
class Parameter:
    """A setting that is searched: among choices, or between bounds.

    Attributes:
        key: the setting's, dotted.
        choices: JSON texts of its values; empty if there are bounds.
        low, high: the bounds, both included.
        log: whether values are drawn on a logarithmic scale.
        step: values are ``low`` plus a multiple of it; None: any values, or 1 for integers.
    """

    key: str
    choices: tuple[str, ...] = ()
    low: float = 0.0
    high: float = 0.0
    log: bool = False
    step: float | None = None

    def suggest(self, trial: "optuna.Trial") -> str:
        """Return a trial's value as the command line takes it."""
        if self.choices:
            text = str(trial.suggest_categorical(self.key, self.choices))
            # Texts have no quotes there; of all else, JSON is TOML.
            value = json.loads(text)
            return value if isinstance(value, str) else text
        if isinstance(self.low, int) and isinstance(self.high, int):
            step = 1 if self.step is None else int(self.step)
            return str(trial.suggest_int(self.key, self.low, self.high, step=step, log=self.log))
        return repr(
            trial.suggest_float(self.key, self.low, self.high, step=self.step, log=self.log)
        )

    def distribution(self) -> "optuna.distributions.BaseDistribution":
        """Return what `suggest` draws from, as a study keeps it."""
        from optuna.distributions import (
            CategoricalDistribution,
            FloatDistribution,
            IntDistribution,
        )

        if self.choices:
            return CategoricalDistribution(self.choices)
        if isinstance(self.low, int) and isinstance(self.high, int):
            step = 1 if self.step is None else int(self.step)
            return IntDistribution(self.low, self.high, self.log, step)
        return FloatDistribution(self.low, self.high, self.log, self.step)

    def has(self, value: Any) -> bool:
        """Tell whether a trial can have this value."""
        if self.choices:
            return value in self.choices
        return type(value) in (int, float) and self.low <= value <= self.high


@dataclass(frozen=True)
class SearchSpace:
    """What is searched, and how trials are compared.

    Attributes:
        parameters: the settings that are searched.
        measure: the measure of validation whose mean should be large.
        startup: trials before the first one may be stopped early.
        warmup: decisions before a trial may be stopped early.
    """

    parameters: tuple[Parameter, ...]
    measure: str = "return"
    startup: int = 5
    warmup: int = 0


def load_space(name: str) -> SearchSpace:
    """Return the search space of a TOML file, or of a packaged one's name.

    Raises `SettingsError` if it names an unknown setting, or values that the setting cannot take.
    """
    source, table = read_toml(name, suffix=".space.toml")
    known = ("measure", "startup", "warmup", "parameters")
    for key in table:
        if key not in known:
            raise SettingsError(f"{source}: unknown key {key!r}; known are {', '.join(known)}")
    measure = table.get("measure", "return")
    if measure not in BEST:
        raise SettingsError(f"{source}: 'measure' must be one of {BEST}, not {measure!r}")
    counts = {key: table.get(key, default) for key, default in (("startup", 5), ("warmup", 0))}
    for key, count in counts.items():
        if type(count) is not int or count < 0:
            raise SettingsError(f"{source}: {key!r} must be an integer, at least 0, not {count!r}")
    parameters = table.get("parameters")
    if not isinstance(parameters, Mapping) or not parameters:
        raise SettingsError(f"{source}: [parameters] must have at least one setting to search")
    found = tuple(_parameter(key, item, source) for key, item in parameters.items())
    return SearchSpace(found, measure, **counts)


def _parameter(key: str, item: Any, source: str) -> Parameter:
    """Return the parameter that a line of the table [parameters] describes."""
    where = f"{source}: parameters.{key!r}"
    if not isinstance(item, Mapping):
        raise SettingsError(f"{where} must be a table such as {{low = 0.1, high = 1.0}}")
    table, _, keyword = key.partition(".")
    keywords = (*(field.name for field in fields(Config)), *BATCH_KEYWORDS)
    if table == "env" and keyword not in keywords:
        raise SettingsError(f"{where}: no such keyword; {keyword_hint(keyword, keywords)}")
    if set(item) == {"choices"}:
        choices = item["choices"]
        if not isinstance(choices, Sequence) or isinstance(choices, str) or not choices:
            raise SettingsError(f"{where}: 'choices' must be a list of values")
        for choice in choices:
            check_value(Experiment, key, choice, source)
        try:
            return Parameter(key, tuple(json.dumps(choice, allow_nan=False) for choice in choices))
        except (TypeError, ValueError):  # dates, and numbers that are not finite
            raise SettingsError(f"{where}: no setting takes such 'choices'") from None
    if not {"low", "high"} <= set(item) <= set(_BOUNDS):
        raise SettingsError(
            f"{where} must have 'choices', or 'low' and 'high' and perhaps 'log' or 'step'"
        )
    for bound in ("low", "high"):
        check_value(Experiment, key, item[bound], source)
    low, high, log, step = item["low"], item["high"], item.get("log"), item.get("step")
    numbers = [low, high, *([] if step is None else [step])]
    if not all(type(number) in (int, float) and abs(number) < _MOST for number in numbers):
        raise SettingsError(f"{where}: 'low', 'high' and 'step' must be numbers below {_MOST}")
    if low >= high:
        raise SettingsError(f"{where}: 'low' and 'high' must be two numbers, 'low' the smaller")
    whole = type(low) is int and type(high) is int
    if step is not None and (step <= 0 or (whole and type(step) is not int)):
        raise SettingsError(f"{where}: 'step' must be above 0, and an integer between integers")
    if log not in (None, True, False) or (log and (step is not None or low <= 0)):
        raise SettingsError(f"{where}: 'log' must be true or false, without 'step', above 0")
    return Parameter(key, low=low, high=high, log=bool(log), step=step)


def open_study(folder: Path, space: SearchSpace, seed: int) -> "optuna.Study":
    """Return the study in a folder; make a new one if there is none.

    A study is a file that needs no server, and several processes may work on it at once. Raises
    `SettingsError` if the file cannot be written, is damaged, or is the study of another search.
    """
    import optuna
    from optuna.storages import JournalStorage
    from optuna.storages.journal import JournalFileBackend

    optuna.logging.set_verbosity(optuna.logging.WARNING)
    journal = folder / _JOURNAL
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if journal.exists() and not journal.is_file():
            raise OSError(errno.EINVAL, "not a regular file")
        storage = JournalStorage(JournalFileBackend(str(journal)))
        study = optuna.create_study(
            storage=storage, study_name="arkanoid", direction="maximize", load_if_exists=True
        )
        _check_study(study, space)
    except OSError as error:
        raise SettingsError(f"{journal}: cannot be written: {cause(error)}") from None
    except SettingsError as error:
        raise SettingsError(f"{journal}: {error}: name another --study") from None
    except Exception as error:  # a damaged file can raise anything
        raise SettingsError(
            f"{journal}: the study cannot be read ({type(error).__name__}: {error}): replace it "
            f"with a copy, or remove it to begin a new study"
        ) from None
    # A resumed search must not repeat its first draws.
    draws = spread_seed(seed, Purpose.SAMPLER, len(study.trials), bits=32)
    study.sampler = optuna.samplers.TPESampler(seed=draws)
    study.pruner = optuna.pruners.MedianPruner(space.startup, space.warmup)
    return study


def _check_study(study: "optuna.Study", space: SearchSpace) -> None:
    """Raise `SettingsError` unless a study is that of a search of this space, or is new.

    Optuna would find out in the middle of a trial, or not at all.
    """
    from optuna.study import StudyDirection
    from optuna.trial import TrialState

    if study.directions != [StudyDirection.MAXIMIZE]:
        raise SettingsError("the study does not look for one large value")
    if "measure" not in study.user_attrs:
        study.set_user_attr("measure", space.measure)
    if study.user_attrs["measure"] != space.measure:
        raise SettingsError(f"the study compares another measure than {space.measure!r}")
    known = {parameter.key: parameter for parameter in space.parameters}
    drawn = {key: parameter.distribution() for key, parameter in known.items()}
    for trial in study.get_trials(deepcopy=False):
        complete = trial.state == TrialState.COMPLETE
        if any(drawn.get(key) != distribution for key, distribution in trial.distributions.items()):
            raise SettingsError("the study searched another space")
        if complete and trial.distributions.keys() != drawn.keys():
            raise SettingsError("the study searched another space")
        if not all(known[key].has(value) for key, value in trial.params.items()):
            raise SettingsError(f"trial {trial.number} has a setting outside its bounds")
        values = trial.values or []
        measured = [*trial.intermediate_values.values(), *values]
        if len(values) > 1 or (complete and not values) or not all(map(_is_finite, measured)):
            raise SettingsError(f"trial {trial.number} was not measured as here")


def _is_finite(value: Any) -> bool:
    return type(value) in (int, float) and abs(value) < math.inf


def search(
    study: "optuna.Study",
    space: SearchSpace,
    config: str,
    overrides: list[tuple[str, str]],
    folder: Path,
    trials: int,
) -> None:
    """Train trials until ``trials`` of the study are complete or stopped early."""
    from optuna.study import MaxTrialsCallback
    from optuna.trial import TrialState

    counted = (TrialState.COMPLETE, TrialState.PRUNED)
    if len(study.get_trials(deepcopy=False, states=counted)) >= trials:
        return
    try:
        study.optimize(
            lambda trial: _run_trial(trial, space, config, overrides, folder),
            callbacks=[MaxTrialsCallback(trials, states=counted), _tell],
        )
    except OSError as error:
        raise SettingsError(f"{folder / _JOURNAL}: cannot be written: {cause(error)}") from None


def _run_trial(
    trial: "optuna.Trial",
    space: SearchSpace,
    config: str,
    overrides: list[tuple[str, str]],
    folder: Path,
) -> float:
    """Train one trial; return its last measurement."""
    import optuna

    from .training import INTERRUPTED, train

    try:
        chosen = [(parameter.key, parameter.suggest(trial)) for parameter in space.parameters]
    except ValueError as error:
        raise SettingsError(
            f"{folder / _JOURNAL}: the study searched another space ({error}): name another --study"
        ) from None
    try:
        experiment = load_experiment(config, [*overrides, *chosen])
    except SettingsError as error:
        # Each value is legal, but not all together: a batch may not divide the rollout.
        print(f"trial {trial.number}: {error}")
        raise optuna.TrialPruned from None
    experiment = replace(
        experiment,
        name=f"trial{trial.number}",
        output=str(folder),
        # No seed that anyone would choose: the best settings are trained anew with other ones.
        seed=spread_seed(experiment.seed, Purpose.TRIAL, trial.number, bits=32),
    )
    latest = float("-inf")

    def judge(step: int, means: dict[str, float]) -> str | None:
        nonlocal latest
        latest = means[space.measure]
        trial.report(latest, step)
        return "pruned" if trial.should_prune() else None

    outcome = train(experiment, RunFolder.create(experiment), on_measure=judge)
    if outcome == INTERRUPTED:
        raise KeyboardInterrupt
    if outcome == "pruned":
        raise optuna.TrialPruned
    return latest


def _tell(study: "optuna.Study", trial: "optuna.trial.FrozenTrial") -> None:
    value = "" if trial.value is None else f"{trial.value:.4f} "
    print(f"trial {trial.number}: {trial.state.name.lower()} {value}{json.dumps(trial.params)}")


def best_as_toml(study: "optuna.Study", space: SearchSpace) -> str:
    """Return the best trial's settings as TOML; raises `SettingsError` if there is none yet."""
    import optuna

    try:
        best = study.best_trial
    except ValueError:
        raise SettingsError("no trial is complete yet, so there is no best one") from None
    complete = study.get_trials(deepcopy=False, states=(optuna.trial.TrialState.COMPLETE,))
    table: dict[str, Any] = {}
    for parameter in space.parameters:
        value = best.params[parameter.key]
        value = json.loads(value) if parameter.choices else value
        *path, name = parameter.key.split(".")
        inner = table
        for part in path:
            inner = inner.setdefault(part, {})
        inner[name] = value
    head = f"# {space.measure} {best.value:.4f}, trial {best.number}, of {len(complete)} complete"
    return f"{head}\n{tomli_w.dumps(table)}"
