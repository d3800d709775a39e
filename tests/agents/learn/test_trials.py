"""The trials of a search: equal processor time, and several side by side."""

import json
import math
import os
import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from arkanoid.agents import cli
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.experiment.settings import load_experiment
from arkanoid.agents.learn.periodic_validation import SECONDS, PeriodicValidation
from arkanoid.agents.learn.search.board import Board
from arkanoid.agents.learn.search.space import Parameter, SearchSpace
from arkanoid.agents.learn.search.study import DECISIONS, open_study
from arkanoid.agents.learn.search.trials import PRUNED, SPENT, Search, _Judge, run_trial
from arkanoid.agents.learn.training import train
from helpers.processes import PATIENCE, run_arkanoid, start_arkanoid, wait_for
from helpers.runs import sentence, small

# One epoch, or sixteen: the second takes several times as long for a decision.
EPOCHS = SearchSpace((Parameter("ppo.n_epochs", ("1", "16")),), budget=1.0, measurements=4)
SMALL = {"training.worlds": "8", "ppo.n_steps": "64", "ppo.batch_size": "64"}
SMALL |= {"validation.episodes": "2", "env.max_decisions": "150"}
WORDS = [f"--{key}={value}" for key, value in SMALL.items()]


class Trial:
    """A trial of which the pruner thinks nothing, or ill."""

    number = 3

    def __init__(self, prunes: bool = False) -> None:
        self.reports: list[tuple[int, float]] = []
        self.prunes = prunes

    def report(self, value: float, step: int) -> None:
        self.reports.append((step, value))

    def should_prune(self) -> bool:
        return self.prunes


def search_of(folder: Path, space: SearchSpace = EPOCHS) -> Search:
    return Search("quick", tuple(SMALL.items()), space, folder, 0)


def test_trials_get_equal_processor_times_and_not_equally_many_decisions(tmp_path: Path) -> None:
    """They were compared after equally many decisions, of which some cost three times as much."""
    search = search_of(tmp_path)
    study = open_study(tmp_path, EPOCHS, 0)
    for epochs in ("1", "16"):
        study.enqueue_trial({"ppo.n_epochs": epochs})
    study.optimize(lambda trial: run_trial(trial, search, lambda *news: None), n_trials=2)
    fast, slow = study.trials
    assert fast.user_attrs[DECISIONS] > 2 * slow.user_attrs[DECISIONS]
    for trial in (fast, slow):
        # Each is a run whose config says how long it trained.
        (path,) = tmp_path.glob(f"trial{trial.number}-*")
        experiment = load_experiment(str(path / "config.toml"))
        assert experiment.training.timesteps == trial.user_attrs[DECISIONS]
        assert experiment.training.torch_threads == experiment.env["threads"] == 1
        notes = RunFolder(path).read_notes()
        # Where it has become slower, it ends with its time.
        all_of_it = notes["timesteps"] == trial.user_attrs[DECISIONS]
        assert notes["outcome"] == ("finished" if all_of_it else SPENT)
        assert trial.user_attrs[SECONDS] > 0
    assert cli.main(["reproduce", str(path)]) == 0


def judge(trial: Trial, decisions: int = 1000) -> tuple[_Judge, list[Any]]:
    space = SearchSpace((), measure="hits", budget=10.0, measurements=5)
    shown: list[Any] = []
    return _Judge(trial, space, decisions, lambda *news: shown.append(news)), shown  # type: ignore[arg-type]


def test_measurements_are_compared_at_equal_times() -> None:
    trial = Trial()
    judged, shown = judge(trial)
    # It trains at half of the speed that was measured before.
    for step, seconds in ((200, 4.0), (400, 8.0)):
        assert judged(step, {"hits": 7.0, SECONDS: seconds}) is None
    assert [step for step, _ in trial.reports] == [2, 4]
    assert judged(600, {"hits": 8.0, SECONDS: 12.0}) == SPENT
    assert shown[-1] == (3, 1.0, 8.0)
    assert (judged.latest, judged.seconds) == (8.0, 12.0)


def test_a_trial_is_stopped_early_but_not_at_its_end() -> None:
    judged, _ = judge(Trial(prunes=True))
    assert judged(200, {"hits": 7.0, SECONDS: 2.0}) == PRUNED
    judged, _ = judge(Trial(prunes=True))
    assert judged(1000, {"hits": 7.0, SECONDS: 11.0}) is None


def test_validation_does_not_count_as_training(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = 0.0
    play = PeriodicValidation._play

    def slow(self: PeriodicValidation) -> dict[str, float]:
        nonlocal clock
        clock += 1000.0
        return play(self)

    monkeypatch.setattr(PeriodicValidation, "_play", slow)
    process_time = time.process_time
    monkeypatch.setattr(time, "process_time", lambda: process_time() + clock)
    seconds: list[float] = []
    experiment = small(tmp_path, **{"validation.every": "512", "validation.episodes": "1"})
    train(
        experiment,
        RunFolder.create(experiment),
        on_measure=lambda step, means: seconds.append(means[SECONDS]),
    )
    assert len(seconds) == 4
    assert seconds == sorted(seconds)
    assert seconds[0] > 0
    assert seconds[-1] < 1000.0


def test_a_run_that_was_stopped_early_is_reproduced_up_to_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It was trained to the end of its budget, and then the weights differed."""
    experiment = small(tmp_path, **{"validation.every": "512", "validation.episodes": "1"})
    folder = RunFolder.create(experiment)
    outcome = train(
        experiment, folder, on_measure=lambda step, means: PRUNED if step >= 1024 else None
    )
    assert outcome == PRUNED
    assert cli.main(["reproduce", str(folder.path)]) == 0
    assert "the same, bit for bit" in capsys.readouterr().out


SPACE = """
measure = "score"
startup = 1
measurements = 2
[parameters]
"ppo.n_epochs" = { low = 1, high = 3 }
"starts" = { choices = [
    { curriculum.stages = [], curriculum.rounds = [3] },
    { curriculum.stages = [0.5], curriculum.rounds = [1, 2] },
] }
"""


def command(folder: Path, *more: str) -> list[str]:
    path = folder / "space.toml"
    path.write_text(SPACE, encoding="utf-8")
    study = str(folder / "study")
    return ["tune", "quick", *WORDS, "--space", str(path), "--study", study, *more]


def test_trials_run_side_by_side_and_share_a_study(tmp_path: Path) -> None:
    words = command(tmp_path, "--jobs", "2", "--trials", "5", "--budget", "0.5")
    done = run_arkanoid(*words)
    told = [line for line in done.stdout.splitlines() if line.startswith("trial ")]
    assert sorted(int(line.split()[1].rstrip(":")) for line in told) == [0, 1, 2, 3, 4]
    assert "# score " in done.stdout
    assert "[curriculum]" in done.stdout
    # Both processes have trained.
    runs = [json.loads(path.read_text()) for path in (tmp_path / "study").glob("*/run.json")]
    assert len(runs) == 5
    assert len({run["seed"] for run in runs}) == 5


@contextmanager
def two_at_once(folder: Path) -> Iterator[tuple[subprocess.Popen[str], list[int]]]:
    """Start a search, wait until two trials have begun; yield it and the trials' processes."""
    words = command(folder, "--jobs", "2", "--trials", "9", "--budget", "30")
    process = start_arkanoid(*words, start_new_session=True)
    trials: list[int] = []
    try:
        checkpoints = folder / "study"
        wait_for(lambda: len(list(checkpoints.glob("*/checkpoint.pt"))) == 2, process)
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        trials += [
            int(child)
            for child in children
            if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()
        ]
        assert len(trials) == 2
        yield process, trials
    finally:
        process.kill()
        process.communicate()
        for trial in filter(is_alive, trials):
            os.kill(trial, signal.SIGKILL)


def is_alive(process: int) -> bool:
    try:
        return ") Z " not in Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False


there_is_proc = pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are found there")


@there_is_proc
@pytest.mark.parametrize("everybody", [True, False])
def test_ctrl_c_ends_all_trials(tmp_path: Path, everybody: bool) -> None:
    """A terminal sends it to its group of processes; `kill` only to the one that is named."""
    with two_at_once(tmp_path) as (process, trials):
        if everybody:
            os.killpg(process.pid, signal.SIGINT)
        else:
            process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=PATIENCE)
        assert process.returncode == 130
        assert "the same command resumes the search" in errors
        assert "Traceback" not in errors
        assert not any(map(is_alive, trials))
    # Each trial was stopped as a run is: it can be resumed.
    for run in (tmp_path / "study").glob("trial*"):
        assert RunFolder(run).read_notes()["outcome"] == "interrupted"


@there_is_proc
def test_a_process_that_was_killed_ends_the_search(tmp_path: Path) -> None:
    with two_at_once(tmp_path) as (process, trials):
        os.kill(trials[0], signal.SIGKILL)
        _, errors = process.communicate(timeout=PATIENCE)
        assert process.returncode == 2
        assert "killed by signal 9" in errors
        assert "--jobs" in errors
        assert not any(map(is_alive, trials))


@there_is_proc
def test_trials_end_with_the_process_that_started_them(tmp_path: Path) -> None:
    with two_at_once(tmp_path) as (process, trials):
        process.kill()
        process.communicate(timeout=PATIENCE)
        wait_for(lambda: not any(map(is_alive, trials)))


def test_the_board_shows_lines_and_counts(capsys: pytest.CaptureFixture[str]) -> None:
    board = Board(1, 4)
    board.progress(7, 0.5, math.nan)
    board.end(7, "complete", 3.0, "{}")
    board.end(8, "pruned", None, "'ppo.batch_size' does not fit")
    board.close()
    out, err = capsys.readouterr()
    assert out.splitlines() == [
        "trial 7: complete 3.0000 {}",
        "trial 8: pruned 'ppo.batch_size' does not fit",
    ]
    assert "3/4" in err


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (["--jobs", "0"], "--jobs: must be an integer, at least 1"),
        (["--trials", "0"], "--trials: must be an integer, at least 1"),
        (["--budget", "0"], "--budget: must be a number above 0"),
        (["--training.timesteps", "1000"], "give --budget"),
        (["--validation.every", "1000"], "give --budget"),
    ],
)
def test_what_a_search_decides_by_itself_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], more: list[str], words: str
) -> None:
    assert words in sentence(command(tmp_path, *more), capsys)
    assert not (tmp_path / "study").exists()


def test_a_study_of_another_budget_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = tmp_path / "study"
    open_study(study, SearchSpace((), measure="score", budget=5.0, measurements=2), 0)
    assert "another budget" in sentence(command(tmp_path, "--budget", "6"), capsys)
