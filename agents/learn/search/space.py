"""The search space of `arkanoid tune`: what is searched, and how trials are compared."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from ....envs.config import Config
from ....envs.hints import BATCH_KEYWORDS, keyword_hint
from ...experiment.errors import SettingsError
from ...experiment.reading import check_value, describe_settings, read_toml
from ...experiment.settings import BEST, Experiment

if TYPE_CHECKING:
    import optuna

_BOUNDS = ("low", "high", "log", "step")
_MOST = 2**53  # of a bound: so all integers below are floats, too
_MEASURES = (*BEST, "hits", "rounds_cleared")
# Trials that differ in these have returns that cannot be compared.
_OF_THE_RETURN = ("env.life_penalty", "env.reward")
_LONGEST = 10**7  # processor seconds of a trial
_MOST_MEASUREMENTS = 1000


@dataclass(frozen=True)
class Parameter:
    """A setting that is searched: among choices, or between bounds.

    Attributes:
        key: the setting's, dotted; of choices that set several settings, any name.
        choices: JSON texts of its values, or of the tables of settings; empty if there are bounds.
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

    def suggest(self, trial: "optuna.Trial") -> list[tuple[str, str]]:
        """Return a trial's settings as the command line takes them: keys and texts."""
        if self.choices:
            choice = json.loads(trial.suggest_categorical(self.key, self.choices))
            return [(key, _as_text(value)) for key, value in self.settings(choice)]
        if isinstance(self.low, int) and isinstance(self.high, int):
            step = 1 if self.step is None else int(self.step)
            value = trial.suggest_int(self.key, self.low, self.high, step=step, log=self.log)
            return [(self.key, str(value))]
        number = trial.suggest_float(self.key, self.low, self.high, step=self.step, log=self.log)
        return [(self.key, repr(number))]

    def settings(self, value: Any) -> Iterator[tuple[str, Any]]:
        """Yield the dotted keys and the values of the settings that a value means."""
        if not isinstance(value, dict):
            yield self.key, value
            return
        for name, item in value.items():
            if isinstance(item, dict):
                yield from ((f"{name}.{key}", inner) for key, inner in item.items())
            else:
                yield name, item

    @property
    def keys(self) -> set[str]:
        """The settings that are searched."""
        values = map(json.loads, self.choices) if self.choices else [0]
        return {key for value in values for key, _ in self.settings(value)}

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
        budget: the training of a trial, in processor seconds.
        measurements: how often a trial is measured, its end included.
        startup: trials before the first one may be stopped early.
        warmup: processor seconds before a trial may be stopped early.
    """

    parameters: tuple[Parameter, ...]
    measure: str = "hits"
    budget: float = 60.0
    measurements: int = 10
    startup: int = 5
    warmup: float = 0.0


def load_space(name: str) -> SearchSpace:
    """Return the search space of a TOML file, or of a packaged one's name.

    Raises `SettingsError` if it names an unknown setting, or values that the setting cannot take.
    """
    source, table = read_toml(name, suffix=".space.toml")
    known = [field.name for field in fields(SearchSpace)]
    for key in table:
        if key not in known:
            raise SettingsError(f"{source}: unknown key {key!r}; known are {', '.join(known)}")
    measure = table.get("measure", SearchSpace.measure)
    if measure not in _MEASURES:
        raise SettingsError(f"{source}: 'measure' must be one of {_MEASURES}, not {measure!r}")
    numbers = {
        "budget": check_budget(table.get("budget", SearchSpace.budget), f"{source}: 'budget'"),
        "measurements": _count(table, "measurements", 1, source),
        "startup": _count(table, "startup", 0, source),
        "warmup": table.get("warmup", SearchSpace.warmup),
    }
    if type(numbers["warmup"]) not in (int, float) or not 0 <= numbers["warmup"] <= _LONGEST:
        raise SettingsError(
            f"{source}: 'warmup' must be processor seconds, at least 0, not {numbers['warmup']!r}"
        )
    parameters = table.get("parameters")
    if not isinstance(parameters, Mapping) or not parameters:
        raise SettingsError(f"{source}: [parameters] must have at least one setting to search")
    found = tuple(_parameter(key, item, source) for key, item in parameters.items())
    _check_together(found, measure, source)
    return SearchSpace(found, measure, **numbers)


def check_budget(budget: Any, where: str) -> float:
    """Return processor seconds, or raise `SettingsError` if they are none."""
    if type(budget) not in (int, float) or not 0 < budget <= _LONGEST:
        raise SettingsError(f"{where} must be processor seconds, above 0, not {budget!r}")
    return float(budget)


def _count(table: Mapping[str, Any], key: str, least: int, source: str) -> int:
    count = table.get(key, getattr(SearchSpace, key))
    if type(count) is not int or not least <= count <= _MOST_MEASUREMENTS:
        raise SettingsError(
            f"{source}: {key!r} must be an integer from {least} to {_MOST_MEASUREMENTS}, not "
            f"{count!r}"
        )
    return count


def _check_together(parameters: Sequence[Parameter], measure: str, source: str) -> None:
    """Refuse a setting that is searched twice, and a measure that cannot compare the trials."""
    keys = [key for parameter in parameters for key in sorted(parameter.keys)]
    for key in keys:
        if keys.count(key) > 1:
            raise SettingsError(f"{source}: {key!r} is searched by two of [parameters]")
        if key in _OF_THE_RETURN and measure == "return":
            raise SettingsError(
                f"{source}: 'measure' = 'return' cannot compare trials that differ in {key!r}, "
                f"which decides what returns are: take 'hits', 'score', 'round' or 'cleared'"
            )
        if key in ("training.timesteps", "validation.every"):
            raise SettingsError(f"{source}: {key!r} follows from 'budget': it cannot be searched")


def _as_text(value: Any) -> str:
    """Return a value as the command line takes it; texts have no quotes there."""
    # Of all else, JSON is TOML.
    return value if isinstance(value, str) else json.dumps(value)


def _parameter(key: str, item: Any, source: str) -> Parameter:
    """Return the parameter that a line of the table [parameters] describes."""
    where = f"{source}: parameters.{key!r}"
    if not isinstance(item, Mapping):
        raise SettingsError(f"{where} must be a table such as {{low = 0.1, high = 1.0}}")
    if set(item) == {"choices"}:
        return _among_choices(key, item["choices"], where, source)
    _check_keyword(key, where)
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


def _among_choices(key: str, choices: Any, where: str, source: str) -> Parameter:
    """Return the parameter of a list of values, or of tables of settings."""
    if not isinstance(choices, Sequence) or isinstance(choices, str) or not choices:
        raise SettingsError(f"{where}: 'choices' must be a list of values")
    several = isinstance(choices[0], Mapping)
    if any(isinstance(choice, Mapping) != several for choice in choices):
        raise SettingsError(f"{where}: 'choices' must be all values, or all tables of settings")
    if several and key in {name.partition(".")[0] for name in describe_settings(Experiment)}:
        raise SettingsError(f"{where}: choices that set several settings need a name of their own")
    try:
        texts = tuple(json.dumps(choice, allow_nan=False) for choice in choices)
    except (TypeError, ValueError):  # dates, and numbers that are not finite
        raise SettingsError(f"{where}: no setting takes such 'choices'") from None
    parameter = Parameter(key, texts)
    for choice in choices:
        for name, value in parameter.settings(choice):
            _check_keyword(name, where)
            check_value(Experiment, name, value, source)
    return parameter


def _check_keyword(key: str, where: str) -> None:
    """Refuse a keyword that the environment does not have."""
    table, _, keyword = key.partition(".")
    keywords = (*(field.name for field in fields(Config)), *BATCH_KEYWORDS)
    if table == "env" and keyword not in keywords:
        raise SettingsError(f"{where}: no such keyword; {keyword_hint(keyword, keywords)}")
