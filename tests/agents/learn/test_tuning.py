"""The search for hyper-parameters: spaces, studies that go on, and their best settings."""

import os
import re
import sys
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import optuna
import pytest
from arkanoid.agents import cli
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.packaged import packaged_configs
from arkanoid.agents.experiment.reading import read_settings
from arkanoid.agents.experiment.settings import Experiment, load_experiment
from arkanoid.agents.learn.search.space import load_space
from arkanoid.agents.learn.search.study import best_as_toml, open_study
from helpers.runs import sentence
from optuna.storages.journal import JournalFileBackend

SPACE = """
measure = "score"
startup = 1
[parameters]
"ppo.learning_rate" = { low = 1e-4, high = 1e-2, log = true }
"ppo.n_epochs" = { low = 1, high = 2 }
"ppo.gamma" = { low = 0.9, high = 1.0, step = 0.05 }
"network.hidden" = { choices = [[8], [16, 16]] }
"network.activation" = { choices = ["relu", "elu"] }
"env.life_penalty" = { choices = [0.1, 0.2] }
"""
SMALL = ["--training.worlds", "8", "--ppo.n_steps", "64", "--ppo.batch_size", "256"]
SMALL += ["--validation.episodes", "2", "--env.max_decisions", "150"]
QUICK = ["--budget", "0.3", "--jobs", "1"]


def space_file(folder: Path, text: str = SPACE) -> str:
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def best_number(best: str) -> str:
    match = re.search(r"trial (\d+)", best)
    assert match is not None
    return match[1]


def test_a_search_resumes_and_prints_the_best(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["tune", "quick", *SMALL, *QUICK, "--space", space_file(tmp_path)]
    arguments += ["--study", str(tmp_path / "study")]
    assert cli.main([*arguments, "--trials", "2"]) == 0
    first = capsys.readouterr().out
    assert "0 trials so far" in first
    assert cli.main([*arguments, "--trials", "4"]) == 0
    out = capsys.readouterr().out
    assert "2 trials so far" in out
    assert re.findall(r"^trial (\d+)", out, re.MULTILINE) == ["2", "3"]
    # A complete study only prints the best.
    assert cli.main([*arguments, "--trials", "4"]) == 0
    again = capsys.readouterr().out
    best = again[again.index("# score") :]
    assert out.endswith(best)
    table = tomllib.loads(best)
    # The printed settings are a part of a config.
    experiment = read_settings(Experiment, table, "best")
    assert 1e-4 <= experiment.ppo.learning_rate <= 1e-2
    assert experiment.network.hidden in ((8,), (16, 16))
    assert experiment.env["life_penalty"] in (0.1, 0.2)
    # Texts were quoted twice: no trial could choose one.
    assert experiment.network.activation in ("relu", "elu")
    # It trains as long as the best trial.
    (run,) = (tmp_path / "study").glob(f"trial{best_number(best)}-*")
    config = load_experiment(str(run / "config.toml"))
    assert experiment.training.timesteps == config.training.timesteps
    space = replace(load_space(space_file(tmp_path)), budget=0.3)
    study = open_study(tmp_path / "study", space, 0)
    value = max(
        trial.value or 0.0
        for trial in study.trials
        if trial.state == optuna.trial.TrialState.COMPLETE
    )
    assert best.startswith(f"# score {value:.4f}")
    # A config of its own trains with them.
    config_file = tmp_path / "best.toml"
    assert cli.main([*arguments, "--trials", "4", "--out", str(config_file)]) == 0
    assert f"arkanoid train {config_file}" in capsys.readouterr().out
    written = load_experiment(str(config_file))
    assert written.ppo.learning_rate == experiment.ppo.learning_rate
    assert written.training.timesteps == experiment.training.timesteps
    assert written.env["landing"] == load_experiment("quick").env["landing"]
    # Each trial is a run like any other.
    assert len(list((tmp_path / "study").glob("trial*/run.json"))) == 4


def test_settings_that_contradict_each_other_make_no_trial(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = space_file(tmp_path, '[parameters]\n"ppo.batch_size" = { choices = [300, 330] }')
    arguments = ["tune", "quick", *SMALL, *QUICK, "--space", path]
    arguments += ["--study", str(tmp_path / "study")]
    assert cli.main([*arguments, "--trials", "2"]) == 2
    out, err = capsys.readouterr()
    assert "'ppo.batch_size'" in out
    assert "no trial is complete" in err


def test_the_packaged_space_is_valid_and_is_not_listed_as_a_config() -> None:
    assert packaged_configs(".space.toml") == ["ppo", "wide"]
    assert not {"ppo", "wide"} & set(packaged_configs())
    keys = {key for parameter in load_space("ppo").parameters for key in parameter.keys}
    assert {"ppo.learning_rate", "network.hidden", "training.worlds"} <= keys
    keys = {key for parameter in load_space("wide").parameters for key in parameter.keys}
    assert {"env.life_penalty", "curriculum.stages", "network.features"} <= keys


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["[parameters]"]),
        ("mesure = 3", ["unknown key 'mesure'", "measure"]),
        ('measure = "hit"', ["'measure'", "'hit'", "'hits'"]),
        ("startup = -1", ["'startup'", "-1"]),
        ("measurements = 0", ["'measurements'", "from 1"]),
        ("budget = 0", ["'budget'", "processor seconds"]),
        ("budget = nan", ["'budget'", "processor seconds"]),
        ("warmup = -1", ["'warmup'", "at least 0"]),
        ('[parameters]\n"training.timesteps" = {low = 1, high = 2}', ["follows from 'budget'"]),
        # Each choice of the penalty made other returns.
        (
            'measure = "return"\n[parameters]\n"env.life_penalty" = {choices = [0.1, 1.0]}',
            ["'return'", "'env.life_penalty'", "'hits'"],
        ),
        ('[parameters]\n"a" = {choices = [{ppo.gama = 1}]}', ["'ppo.gama'", "'ppo.gamma'"]),
        ('[parameters]\n"a" = {choices = [{ppo.gamma = 2.0}]}', ["'ppo.gamma'", "at most 1"]),
        ('[parameters]\n"a" = {choices = [{env.frame_ship = 2}]}', ["'frame_skip'"]),
        ('[parameters]\n"a" = {choices = [{ppo.gamma = 1.0}, 3]}', ["all tables"]),
        ('[parameters]\n"env" = {choices = [{env.lives = 1}]}', ["a name of their own"]),
        (
            '[parameters]\n"a" = {choices = [{ppo.gamma = 1.0}]}\n"ppo.gamma" = {choices = [0.9]}',
            ["'ppo.gamma'", "by two"],
        ),
        ('[parameters]\n"ppo.gama" = {low = 0.1, high = 0.2}', ["'ppo.gama'", "'ppo.gamma'"]),
        ('[parameters]\n"ppo.gamma" = 3', ["'ppo.gamma'", "a table"]),
        ('[parameters]\n"ppo.gamma" = {low = 0.1}', ["'ppo.gamma'", "'low' and 'high'"]),
        ('[parameters]\n"ppo.gamma" = {low = 0.1, high = 2.0}', ["'ppo.gamma'", "at most 1"]),
        ('[parameters]\n"ppo.gamma" = {low = 0.2, high = 0.1}', ["'low' the smaller"]),
        ('[parameters]\n"ppo.gamma" = {low = 0.0, high = 1.0, log = true}', ["'log'", "above 0"]),
        ('[parameters]\n"ppo.gamma" = {low = 0.1, high = 0.9, step = 0}', ["'step'"]),
        ('[parameters]\n"ppo.n_epochs" = {low = 1, high = 3, step = 0.5}', ["'step'"]),
        ('[parameters]\n"env.life_penalty" = {low = 0.1, high = inf}', ["numbers below"]),
        (f'[parameters]\n"env.speed" = {{low = 1, high = 1{"0" * 400}}}', ["numbers below"]),
        ('[parameters]\n"env.speed" = {choices = [nan]}', ["'env.speed'", "'choices'"]),
        ('[parameters]\n"env.speed" = {choices = [1979-05-27]}', ["'env.speed'", "'choices'"]),
        ('[parameters]\n"ppo.gamma" = {choices = []}', ["'ppo.gamma'", "'choices'"]),
        ('[parameters]\n"ppo.gamma" = {choices = [0.5, "x"]}', ["'ppo.gamma'", "'x'"]),
        ('[parameters]\n"network.activation" = {choices = ["rellu"]}', ["'relu'", "'rellu'"]),
        # All trials were run, each without a result.
        ('[parameters]\n"env.frame_ship" = {choices = [2]}', ["'env.frame_ship'", "'frame_skip'"]),
    ],
)
def test_an_error_in_a_space_names_the_file_and_what_is_right(
    tmp_path: Path, text: str, words: list[str]
) -> None:
    path = space_file(tmp_path, text)
    with pytest.raises(SettingsError) as caught:
        load_space(path)
    assert path in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def foreign(folder: Path, **arguments: Any) -> optuna.Study:
    """Begin somebody else's study where the command looks for its own."""
    storage = optuna.storages.JournalStorage(JournalFileBackend(str(folder / "study.journal")))
    arguments = {"direction": "maximize", **arguments}
    return optuna.create_study(storage=storage, study_name="arkanoid", **arguments)


def several(folder: Path) -> None:
    foreign(folder, direction=None, directions=["maximize", "minimize"])


def smallest(folder: Path) -> None:
    foreign(folder, direction="minimize")


def other_parameters(folder: Path) -> None:
    foreign(folder).optimize(lambda trial: trial.suggest_float("x", 0.0, 1.0), 1)


def other_bounds(folder: Path) -> None:
    foreign(folder).optimize(lambda trial: trial.suggest_float("ppo.gamma", 0.5, 0.9), 1)


def fewer_parameters(folder: Path) -> None:
    foreign(folder).optimize(lambda trial: 1.0, 1)


def other_measure(folder: Path) -> None:
    foreign(folder).set_user_attr("measure", "hits")


def infinite(folder: Path) -> None:
    def play(trial: optuna.Trial) -> float:
        return trial.suggest_float("ppo.gamma", 0.9, 1.0) * float("inf")

    foreign(folder).optimize(play, 1)


def a_pipe(folder: Path) -> None:
    os.mkfifo(folder / "study.journal")


def a_folder(folder: Path) -> None:
    (folder / "study.journal").mkdir()


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such pipes")
@pytest.mark.parametrize(
    "make",
    [
        *(several, smallest, other_parameters, other_bounds, fewer_parameters, other_measure),
        *(infinite, a_pipe, a_folder),
    ],
)
def test_the_study_of_another_search_is_named_before_the_training(
    make: Callable[[Path], None], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A study of two values trained a trial, and then raised Optuna's NotImplementedError."""
    study = tmp_path / "study"
    study.mkdir()
    make(study)
    path = space_file(tmp_path, '[parameters]\n"ppo.gamma" = {low = 0.9, high = 1.0}')
    arguments = ["tune", "quick", *SMALL, *QUICK, "--space", path, "--study", str(study)]
    assert str(study / "study.journal") in sentence([*arguments, "--trials", "3"], capsys)
    assert [file.name for file in study.iterdir()] == ["study.journal"]


def test_without_a_complete_trial_there_is_no_best(tmp_path: Path) -> None:
    space = load_space("ppo")
    with pytest.raises(SettingsError, match="no trial is complete"):
        best_as_toml(open_study(tmp_path, space, 0), space)
