"""Training and evaluation on the game itself, from the command line down."""

import hashlib
import json
import re
import signal
import threading
from dataclasses import replace
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.agents import cli
from arkanoid.agents.adapter import GymnasiumVecEnv
from arkanoid.agents.commands.arguments import Parser
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.experiment.seeds import Purpose, spread_seeds
from arkanoid.agents.experiment.settings import Experiment, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds, native
from arkanoid.agents.learn import model as learning
from arkanoid.agents.learn import training
from arkanoid.agents.learn.curves import read_curve
from arkanoid.agents.measure.comparison import COLUMNS
from arkanoid.agents.measure.episodes import adapt
from arkanoid.envs.game.random import seed_state
from helpers.processes import PATIENCE, run_arkanoid, run_program, start_arkanoid, wait_for
from numpy.typing import NDArray
from PIL import Image
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import DummyVecEnv

TINY = ["--training.timesteps", "1024", "--training.worlds", "8", "--ppo.n_steps", "64"]
TINY += ["--ppo.batch_size", "256", "--evaluation.episodes", "4", "--evaluation.film_seconds", "1"]
# However few games there are, good baselines play long ones.
TINY += ["--env.max_decisions", "300"]


def weights(model: PPO) -> list[NDArray[np.float32]]:
    return [value.numpy().copy() for value in model.policy.state_dict().values()]


@pytest.fixture(scope="module")
def trained(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    """The packaged quick experiment with a quarter of its budget."""
    output = tmp_path_factory.mktemp("runs")
    overrides = ["--training.timesteps", "1_000_000", "--evaluation.episodes", "40"]
    overrides += ["--evaluation.film_seconds", "2", "--output", str(output)]
    assert cli.main(["train", "quick", *overrides]) == 0
    (path,) = output.iterdir()
    return RunFolder(path)


def test_a_short_training_beats_the_baselines_clearly(trained: RunFolder) -> None:
    results = json.loads(trained.evaluation.read_text())["suites"]["games"]["policies"]
    assert set(results) == {"agent", "no-op", "random", "ball-follower", "landing-follower"}
    for measure in ("score", "hits"):
        means = {name: result["summary"][measure]["mean"] for name, result in results.items()}
        assert means["agent"]["low"] > 10 * means["random"]["high"]
        assert means["agent"]["low"] > 1.25 * means["ball-follower"]["high"]


def test_a_run_keeps_all_that_is_needed_to_judge_and_to_repeat_it(trained: RunFolder) -> None:
    experiment = trained.experiment()
    assert experiment.training.timesteps == 1_000_000
    assert experiment == replace(
        load_experiment("quick"),
        output=experiment.output,
        training=experiment.training,
        evaluation=experiment.evaluation,
    )
    assert list(trained.log.glob("events.out.tfevents.*"))
    last = read_curve(trained.curve)[-1]
    assert last["timesteps"] >= 1_000_000
    assert {"rollout/ep_rew_mean", "rollout/ep_hits_mean", "rollout/ep_score_mean"} <= set(last)
    about = trained.read_notes()
    assert {"arkanoid", "python", "numpy", "torch", "stable_baselines3"} <= set(about["versions"])
    assert about["hardware"]["cores"] >= 1
    assert (about["seed"], about["outcome"]) == (0, "finished")
    assert "warnings" not in about
    (session,) = about["sessions"]
    assert (session["from"], session["to"]) == (0, last["timesteps"])
    assert about["git"] is None or len(about["git"]["commit"]) == 40
    # The file needs nothing but stable-baselines3.
    state = PPO.load(trained.model, device="cpu").policy.state_dict()
    digest = hashlib.sha256()
    for name, tensor in sorted(state.items()):
        array = tensor.numpy()
        digest.update(f"{name} {array.dtype.str} {array.shape}\n".encode() + array.tobytes())
    assert digest.hexdigest() == about["weights"]
    with Image.open(trained.film) as clip:
        assert getattr(clip, "n_frames", 1) > 10


def test_evaluating_the_saved_model_gives_the_same_numbers(
    trained: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["evaluate", str(trained.path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == json.loads(trained.evaluation.read_text())


def test_overrides_change_how_a_saved_model_is_evaluated(
    trained: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    """A run and its model are evaluated alike, and the table has the numbers of the JSON."""
    overrides = ["--evaluation.episodes", "3", "--env.lives", "1", "--env.max_decisions", "300"]
    told = []
    for path in (trained.path, trained.model):
        assert cli.main(["evaluate", str(path), "--json", *overrides]) == 0
        told.append(json.loads(capsys.readouterr().out))
    results, of_the_model = told
    assert results == of_the_model
    games = results["suites"]["games"]
    assert games["episodes"] == 3
    assert results["env"]["lives"] == 1
    assert cli.main(["evaluate", str(trained.path), *overrides]) == 0
    table = capsys.readouterr().out
    for heading in COLUMNS.values():
        assert heading in table
    score = games["policies"]["agent"]["summary"]["score"]["mean"]["estimate"]
    assert re.search(rf"^agent .* {score:.0f} ±", table, re.MULTILINE)


def test_the_weights_are_those_of_training_on_dummy_vec_env() -> None:
    """Of the native batch and of single environments, with episodes that end or are truncated."""
    experiment = load_experiment("quick", [("env.max_decisions", "90"), ("env.lives", "2")])

    def train(venv: Any) -> list[NDArray[np.float32]]:
        model = PPO("MlpPolicy", venv, n_steps=64, batch_size=64, n_epochs=2, seed=4, device="cpu")
        model.learn(2048)
        return weights(model)

    native = train(GymnasiumVecEnv(make_worlds(experiment, 4)))
    singles = train(DummyVecEnv([lambda: gym.make("ArkanoidLite-v0", **experiment.env)] * 4))
    for ours, theirs in zip(native, singles, strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_the_same_seed_gives_the_same_weights_and_another_seed_others() -> None:
    def train(seed: str) -> list[NDArray[np.float32]]:
        small = [("training.worlds", "8"), ("ppo.n_steps", "64"), ("ppo.batch_size", "256")]
        experiment = load_experiment("quick", [("seed", seed), *small])
        model = learning.make_model(experiment, adapt(make_worlds(experiment, 8)))
        model.learn(1024)
        return weights(model)

    first, again, other = train("3"), train("3"), train("4")
    for ours, theirs in zip(first, again, strict=True):
        np.testing.assert_array_equal(ours, theirs)
    assert any((ours != theirs).any() for ours, theirs in zip(first, other, strict=True))


def test_neighbouring_seeds_share_no_world(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """World i of seed s had the seed s + i: seeds 0 and 1 shared 63 of 64 worlds' generators.

    The worlds began with the same levels, capsules and serves, so intervals over seeds, which take
    runs to be independent, were too narrow.
    """
    begun: list[int] = []

    def watched(worlds: Any) -> GymnasiumVecEnv:
        venv = adapt(worlds)
        reset = venv.reset

        def look() -> Any:
            observations = reset()
            begun.extend(native(worlds).state["first_random"].tolist())
            return observations

        monkeypatch.setattr(venv, "reset", look)
        return venv

    monkeypatch.setattr(training, "adapt", watched)
    for seed in ("0", "1"):
        small = [("seed", seed), ("training.worlds", "64"), ("ppo.n_steps", "8")]
        small += [("training.timesteps", "512"), ("ppo.batch_size", "512")]
        experiment = load_experiment("quick", [*small, ("output", str(tmp_path))])
        training.train(experiment, RunFolder.create(experiment))
    assert len(begun) == len(set(begun)) == 128
    # And no two of a thousand seeds.
    states = {
        seed_state(each)
        for seed in range(1000)
        for each in spread_seeds(seed, Purpose.TRAINING, 64)
    }
    assert len(states) == 64_000
    assert states >= set(begun)


def test_an_environment_that_refuses_its_arguments_is_a_settings_error() -> None:
    """The settings know nothing about level files; the environment reads them."""
    experiment = replace(Experiment(), env={"levels": "no_such_level"})
    with pytest.raises(
        SettingsError, match=r"Arkanoid-v0 refuses the \[env\] table.*no_such_level"
    ):
        make_worlds(experiment, 2)


def test_python_dash_m_arkanoid_is_the_command(tmp_path: Path) -> None:
    """From a TOML file in a user's folder to a table, with a tiny budget."""
    config = tmp_path / "mine.toml"
    config.write_text('name = "mine"\noutput = "here"\n[env]\nactions = "discrete6"\n')
    trained = run_arkanoid("train", "mine.toml", *TINY, cwd=tmp_path)
    assert "ball-follower" in trained.stdout
    (folder,) = (tmp_path / "here").iterdir()
    assert folder.name.startswith("mine-seed0-")
    for kept in ("model.zip", "config.toml", "run.json", "curve.jsonl", "log", "play.gif"):
        assert (folder / kept).exists()
    assert str(Path("here") / folder.name / "model.zip") in trained.stdout
    assert json.loads((folder / "evaluation.json").read_text())["suites"]["games"]["episodes"] == 4


def test_ctrl_c_saves_the_model(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--training.timesteps", "1_000_000_000", "--output", str(tmp_path)]
    process = start_arkanoid("train", *TINY, *arguments)
    # The training writes the first line of its curves long before its end.
    curves = "*/curve.jsonl"
    wait_for(lambda: any(file.stat().st_size for file in tmp_path.glob(curves)), process)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130, err
    (folder,) = tmp_path.iterdir()
    assert str(folder / "model.zip") in out
    assert f"arkanoid train --resume {folder}" in out
    assert "Traceback" not in err
    assert cli.main(["evaluate", str(folder)]) == 0
    assert "agent" in capsys.readouterr().out


def test_training_in_a_thread_leaves_signals_alone(tmp_path: Path) -> None:
    """Only the main thread may handle signals; Python raises an error in others."""
    overrides = list(zip((key[2:] for key in TINY[::2]), TINY[1::2], strict=True))
    experiment = replace(load_experiment("quick", overrides), output=str(tmp_path))
    outcomes: list[str] = []
    folder = RunFolder.create(experiment)
    thread = threading.Thread(target=lambda: outcomes.append(training.train(experiment, folder)))
    thread.start()
    thread.join()
    assert outcomes == ["finished"]


def test_the_console_script_is_the_same_command() -> None:
    (script,) = entry_points(group="console_scripts", name="arkanoid")
    assert script.load() is cli.main


def test_help_imports_nothing_slow() -> None:
    result = run_program(
        "import sys; from arkanoid.agents.cli import main\n"
        "try: main(['train', '--help'])\n"
        "except SystemExit as stop: assert stop.code == 0\n"
        "assert not {'torch', 'stable_baselines3', 'numba', 'tqdm'} & set(sys.modules)"
    )
    assert "--ppo.learning_rate" in result.stdout


@pytest.mark.parametrize(
    ("package", "command"),
    [
        ("pydantic", "train"),
        ("torch", "train"),
        ("stable_baselines3", "train"),
        ("tqdm", "train"),
        ("optuna", "tune quick --trials 1"),
    ],
)
def test_without_the_extra_it_says_what_to_install(package: str, command: str) -> None:
    result = run_program(
        f"import sys; sys.modules[{package!r}] = None; from arkanoid.agents.cli import main; "
        f"sys.exit(main({command.split()!r}))",
        status=1,
    )
    assert 'pip install -e ".[train]"' in result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["train", "no_such.toml"], ["no_such.toml", "quick"]),
        (["train", "--ppo.gama", "1"], ["command line", "'ppo.gama'", "'ppo.gamma'"]),
        (["train", "--ppo.gama=1"], ["command line", "'ppo.gama'", "'ppo.gamma'"]),
        (["train", "--env.lives", "none", *TINY], ["ArkanoidLite-v0", "lives must be an integer"]),
        (["train", "quick", "--env.livs", "3"], ["ArkanoidLite-v0", "livs", "lives"]),
        (["train", "--resume", "no_such_run"], ["no_such_run", "config.toml"]),
        (["train", "quick", "--resume", "x"], ["--resume", "no others"]),
        (["reproduce", "no_such_run"], ["no_such_run", "config.toml"]),
        (["evaluate", "no_such_run"], ["no_such_run", "the folder of a run"]),
        (["film", "no_such_run", "x.gif"], ["no_such_run", "the folder of a run"]),
        (["watch", "no_such_run"], ["no_such_run", "the folder of a run"]),
        (["report", "no_such_run"], ["no_such_run", "the folder of a run"]),
        (["report", "no_such_run", "--out", "x.pdf"], ["x.pdf", ".html or .md"]),
        (["tune", "quick", "--space", "no_such.toml"], ["no_such.toml", "ppo"]),
        (["tune", "quick", "--validation.every", "9"], ["'validation.every'", "--budget"]),
        (["tune", "quick", "--trials", "0"], ["--trials", "0"]),
    ],
)
def test_a_mistake_gets_one_line_and_exit_status_2(
    arguments: list[str], words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(arguments) == 2
    message = capsys.readouterr().err
    assert message.startswith("arkanoid: error: ")
    assert message.count("\n") == 1
    for word in words:
        assert word in message


def test_a_setting_without_a_value_is_a_mistake(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["train", "--seed"]) == 2
    assert "--seed needs a value" in capsys.readouterr().err


def test_a_value_may_begin_with_a_minus() -> None:
    parser = Parser()
    parser.add_argument("--json", action="store_true")
    given = ["train", "x", "--seed", "-1", "--a.b=c=d", "--json"]
    words, overrides = cli.split_overrides(given, parser)
    assert words == ["train", "x", "--json"]
    assert overrides == [("seed", "-1"), ("a.b", "c=d")]


def test_two_runs_in_one_second_get_two_folders(tmp_path: Path) -> None:
    experiment = replace(Experiment(), output=str(tmp_path / "new" / "runs"))
    paths = {RunFolder.create(experiment).path for _ in range(3)}
    assert len(paths) == 3


def test_an_output_that_is_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(SettingsError, match=r"'output' cannot be written to: .*: [A-Z]"):
        RunFolder.create(replace(Experiment(), output=str(tmp_path / "file")))
