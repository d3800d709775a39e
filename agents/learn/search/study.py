"""The study of a search: a file with its trials, which several processes share."""

import errno
import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tomli_w

from ...experiment.errors import SettingsError
from ...experiment.files import cause
from ...experiment.seeds import Purpose, spread_seed
from ..periodic_validation import SECONDS
from .space import SearchSpace

if TYPE_CHECKING:
    import optuna

JOURNAL = "study.journal"
_JOBS = 256  # whose draws differ
DECISIONS = "decisions"  # what a trial notes: of its training


def open_study(folder: Path, space: SearchSpace, seed: int, job: int = 0) -> "optuna.Study":
    """Return the study in a folder; make a new one if there is none.

    A study is a file that needs no server, and several processes may work on it at once, each as a
    ``job`` of its own, with other draws. Raises
    `SettingsError` if the file cannot be written, is damaged, or is the study of another search.
    """
    import optuna
    from optuna.storages import JournalStorage
    from optuna.storages.journal import JournalFileBackend

    # It would show how Ctrl-C went through its code.
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    journal = folder / JOURNAL
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
    place = len(study.trials) * _JOBS + job
    draws = spread_seed(seed, Purpose.SAMPLER, place, bits=32)
    study.sampler = optuna.samplers.TPESampler(seed=draws)
    warmup = math.ceil(space.warmup / space.budget * space.measurements)
    study.pruner = optuna.pruners.MedianPruner(space.startup, warmup)
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
        study.set_user_attr("budget", space.budget)
        study.set_user_attr("measurements", space.measurements)
    if study.user_attrs["measure"] != space.measure:
        raise SettingsError(f"the study compares another measure than {space.measure!r}")
    for name in ("budget", "measurements"):
        if study.user_attrs.get(name) != getattr(space, name):
            raise SettingsError(f"the study has another {name} than {getattr(space, name):g}")
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


def count_ended(study: "optuna.Study") -> int:
    """Return how many trials are complete or were stopped early."""
    from optuna.trial import TrialState

    states = (TrialState.COMPLETE, TrialState.PRUNED)
    return len(study.get_trials(deepcopy=False, states=states))


def best_as_toml(study: "optuna.Study", space: SearchSpace) -> str:
    """Return the best trial's settings as TOML; raises `SettingsError` if there is none yet."""
    import optuna

    try:
        best = study.best_trial
    except ValueError:
        raise SettingsError("no trial is complete yet, so there is no best one") from None
    complete = study.get_trials(deepcopy=False, states=(optuna.trial.TrialState.COMPLETE,))
    decisions, seconds = (best.user_attrs.get(name) for name in (DECISIONS, SECONDS))
    table: dict[str, Any] = {}
    if type(decisions) is int:
        table["training"] = {"timesteps": decisions}
    for parameter in space.parameters:
        value = best.params[parameter.key]
        value = json.loads(value) if parameter.choices else value
        for key, setting in parameter.settings(value):
            _put(table, key, setting)
    head = f"# {space.measure} {best.value:.4f}, trial {best.number}, of {len(complete)} complete"
    if _is_finite(seconds):
        head += f", {seconds:.0f} processor seconds"
    return f"{head}\n{tomli_w.dumps(table)}"


def _put(table: dict[str, Any], key: str, value: Any) -> None:
    """Set a dotted key of nested tables."""
    *path, name = key.split(".")
    for part in path:
        table = table.setdefault(part, {})
    table[name] = value
