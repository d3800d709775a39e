"""Runs that are killed, stopped, resumed and reproduced have the same weights, bit for bit."""

import json
import signal
from pathlib import Path
from typing import Any

import pytest
from arkanoid.agents import cli
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.experiment.settings import load_experiment
from arkanoid.agents.learn.curves import STEP, CurveWriter, read_curve
from arkanoid.agents.learn.training import train
from helpers.processes import run_program
from helpers.runs import small

# Everything that has a state is in use: a schedule, a curriculum, validation, generated levels and
# sticky actions. Episodes are short: many end, and some are truncated.
RUN = {
    "training.timesteps": "12_288",
    "training.worlds": "16",
    "training.checkpoint_every": "2048",
    "ppo.n_steps": "64",
    "ppo.batch_size": "256",
    "ppo.n_epochs": "2",
    "network.features": "lattice",
    "env.levels": "train",
    "env.sticky_action": "0.1",
    "env.max_decisions": "150",
    "curriculum.stages": "[0.3, 0.6]",
    "curriculum.difficulty": "[0.1, 0.3, 0.6]",
    "validation.every": "4096",
    "validation.episodes": "4",
    "evaluation.episodes": "2",
    "evaluation.baselines": "[]",
    "evaluation.film_seconds": "0.5",
    "evaluation.deterministic": "false",
}
# What differs from run to run: the clock.
CLOCK = {"time/fps", "time/time_elapsed", "time/iterations"}


def words(output: Path, **changes: str) -> list[str]:
    settings = {**RUN, **changes, "output": str(output)}
    return ["train", "quick", *(f"--{key}={value}" for key, value in settings.items())]


# A training gets a signal once it has written a line of its curves after so many decisions.
STOPPED = """
import os, sys
from arkanoid.agents import cli
from arkanoid.agents.learn.curves import CurveWriter

timesteps, signal, write = int(sys.argv[1]), int(sys.argv[2]), CurveWriter.write

def write_and_stop(writer, values, excluded, step=0):
    write(writer, values, excluded, step)
    if step >= timesteps:
        CurveWriter.write = write
        os.kill(os.getpid(), signal)

CurveWriter.write = write_and_stop
sys.exit(cli.main(sys.argv[3:]))
"""


def stop_at(output: Path, timesteps: int, how: int) -> RunFolder:
    """Train, and send a signal to the training after so many decisions."""
    arguments = (str(timesteps), str(int(how)), *words(output))
    run_program(STOPPED, *arguments, warnings="default", status=None)
    (path,) = output.iterdir()
    return RunFolder(path)


def curve(run: RunFolder) -> list[dict[str, Any]]:
    rows = read_curve(run.curve)
    return [{key: value for key, value in row.items() if key not in CLOCK} for row in rows]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    output = tmp_path_factory.mktemp("whole")
    assert cli.main(words(output)) == 0
    (path,) = output.iterdir()
    return RunFolder(path)


def test_a_killed_and_resumed_run_equals_an_undisturbed_one(
    whole: RunFolder, tmp_path: Path
) -> None:
    killed = stop_at(tmp_path, 5120, signal.SIGKILL)
    assert killed.read_notes()["outcome"] == "unfinished"
    assert "weights" not in killed.read_notes()
    # Reports left out the time of a session that was killed, because nothing was noted about it.
    (session,) = killed.read_notes()["sessions"]
    assert session["from"] == 0
    assert session["to"] >= 4096
    assert session["seconds"] > 0
    assert cli.main(["train", "--resume", str(killed.path)]) == 0
    assert killed.read_notes()["outcome"] == "finished"
    assert killed.read_notes()["weights"] == whole.read_notes()["weights"]
    first, second = killed.read_notes()["sessions"]
    assert (first["from"], first["to"]) == (0, second["from"])
    assert second["to"] == 12_288
    # The curves and the best model are the same, too.
    assert curve(killed) == curve(whole)
    expected = json.loads(whole.evaluation.read_text())["suites"]
    assert json.loads(killed.evaluation.read_text())["suites"] == expected


def test_a_stopped_and_resumed_run_equals_an_undisturbed_one(
    whole: RunFolder, tmp_path: Path
) -> None:
    """It stops in the middle of a rollout, which the resumed run plays from its beginning."""
    stopped = stop_at(tmp_path, 3072, signal.SIGINT)
    about = stopped.read_notes()
    assert about["outcome"] == "interrupted"
    assert about["weights"] is None
    assert about["timesteps"] % 1024 == 0
    assert cli.main(["evaluate", str(stopped.path)]) == 0
    assert cli.main(["train", "--resume", str(stopped.path)]) == 0
    about = stopped.read_notes()
    assert about["weights"] == whole.read_notes()["weights"]
    first, second = about["sessions"]
    assert (first["from"], first["to"]) == (0, second["from"])
    assert second["to"] == 12_288


def test_a_finished_run_cannot_be_resumed(
    whole: RunFolder, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["train", "--resume", str(whole.path)]) == 2
    assert "nothing to resume" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("content", "message"),
    [(None, "no checkpoint"), (b"PK no", "cannot be read")],
)
def test_the_error_names_a_missing_or_damaged_checkpoint(
    content: bytes | None, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    overrides = [*RUN.items(), ("output", str(tmp_path))]
    run = RunFolder.create(load_experiment("quick", overrides))
    if content is not None:
        run.checkpoint.write_bytes(content)
    assert cli.main(["train", "--resume", str(run.path)]) == 2
    error = capsys.readouterr().err
    assert str(run.checkpoint) in error
    assert message in error


def test_a_run_is_reproduced(whole: RunFolder, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["reproduce", str(whole.path)]) == 0
    assert "the same, bit for bit" in capsys.readouterr().out


def test_a_failed_reproduction_says_what_is_different(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    overrides = [*RUN.items(), ("output", str(tmp_path)), ("training.timesteps", "1024")]
    experiment = load_experiment("quick", overrides)
    run = RunFolder.create(experiment)
    train(experiment, run)
    versions = {**run.read_notes()["versions"], "torch": "1.0"}
    run.add_notes(weights="0" * 64, versions=versions)
    assert cli.main(["reproduce", str(run.path)]) == 1
    out = capsys.readouterr().out
    assert "they differ" in out
    assert "versions.torch: '1.0' there" in out
    run.add_notes(weights=None)
    assert cli.main(["reproduce", str(run.path)]) == 2
    assert "has not ended" in capsys.readouterr().err


def test_curves_continue_at_the_checkpoints_step(tmp_path: Path) -> None:
    path = tmp_path / "curve.jsonl"
    writer = CurveWriter(path)
    for step in (10, 20, 30):
        writer.write({"b": 0.5 * step, "a": 1, "text": "no number"}, {}, step)
    writer.close()
    with path.open("a") as file:
        file.write('{"timesteps": 40, "a"')  # killed while it wrote
    assert [row[STEP] for row in read_curve(path)] == [10, 20, 30]
    writer = CurveWriter(path, resumed_at=20)
    writer.write({"a": 3}, {}, 35)
    writer.close()
    assert read_curve(path) == [
        {STEP: 10, "a": 1.0, "b": 5.0},
        {STEP: 20, "a": 1.0, "b": 10.0},
        {STEP: 35, "a": 3.0},
    ]
    CurveWriter(path).close()
    assert read_curve(path) == []


def test_a_run_that_validation_ended_does_not_train_on(tmp_path: Path) -> None:
    """The reason was only in run.json, and the process died before it was written there."""
    # Nothing is ever cleared: the second measurement is not better than the first.
    ended = {"validation.every": "512", "validation.episodes": "1", "validation.patience": "1"}
    experiment = small(tmp_path, **ended)
    whole, run = RunFolder.create(experiment), RunFolder.create(experiment)
    outcome = train(experiment, whole)
    assert "without a better one at 1024" in outcome
    run.model.mkdir()
    with pytest.raises(SettingsError, match=r"/model\.zip failed") as caught:
        train(experiment, run)
    assert f"arkanoid train --resume {run.path}" in str(caught.value)
    assert run.read_notes()["outcome"] == "unfinished"
    run.model.rmdir()
    assert train(experiment, run, resumed=True) == outcome
    for name in ("outcome", "timesteps", "weights"):
        assert run.read_notes()[name] == whole.read_notes()[name]
    assert curve(run) == curve(whole)


def test_an_interrupted_run_that_validation_ended_only_has_to_finish(tmp_path: Path) -> None:
    """Ctrl-C during a measurement that ends a trial let the search go on."""
    experiment = small(tmp_path, **{"validation.every": "512", "validation.episodes": "1"})
    run = RunFolder.create(experiment)

    def judge(step: int, means: dict[str, float]) -> str:
        signal.raise_signal(signal.SIGINT)
        return "pruned"

    assert train(experiment, run, on_measure=judge) == "interrupted"
    assert train(experiment, run, resumed=True) == "pruned"
    assert run.read_notes()["timesteps"] == 512
