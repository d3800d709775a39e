"""Prioritised level replay: which levels a training chooses, and that a resumed one does, too."""

import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.runs import INTERRUPTED, RunFolder
from arkanoid.agents.experiment.settings import Experiment, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds, native
from arkanoid.agents.learn.checkpoints import read_checkpoint, write_checkpoint
from arkanoid.agents.learn.levels.kept import KeptLevels, Level
from arkanoid.agents.learn.levels.sampling import LEVELS, PrioritisedLevels, advantages
from arkanoid.agents.learn.model import make_model
from arkanoid.agents.learn.training import train
from arkanoid.agents.measure.episodes import adapt
from arkanoid.envs.levels import generate_level
from helpers.runs import small
from stable_baselines3.common.callbacks import BaseCallback

SEEDS = {
    "env.levels": "seeds:100-119",
    "env.max_decisions": "60",
    "env.lives": "1",
    "curriculum.sampling": "value_loss",
    "curriculum.difficulty": "[0.3, 0.6]",
    "curriculum.stages": "[0.5]",
}
ROUNDS = {
    "env.max_decisions": "60",
    "env.lives": "1",
    "curriculum.sampling": "positive_value_loss",
    "curriculum.stages": "[0.5]",
    "curriculum.rounds": "[3, 6]",
}


def test_probabilities_are_those_of_the_paper() -> None:
    kept = KeptLevels(10, temperature=0.5, staleness=0.25, state={})
    for number, score in enumerate((0.1, 0.7, 0.3)):
        kept.note(Level(number, 0.5), score, clock=number)
    # P_S by ranks 3, 1, 2 and 1 / temperature = 2; P_C by ages 8, 7, 6.
    by_score = np.array([1 / 9, 1, 1 / 4]) / (1 / 9 + 1 + 1 / 4)
    by_age = np.array([8, 7, 6]) / 21
    np.testing.assert_allclose(kept.probabilities(8), 0.75 * by_score + 0.25 * by_age)
    bounds = np.cumsum(kept.probabilities(8))
    drawn = kept.draw(np.array([0.0, bounds[0] + 1e-9, bounds[1] + 1e-9, 1 - 1e-16]), 8)
    assert [level.number for level in drawn] == [0, 1, 2, 2]
    # All were drawn now: none is stale.
    np.testing.assert_allclose(kept.probabilities(8), 0.75 * by_score + 0.25 / 3)


def test_the_lowest_score_makes_room_and_a_lower_one_is_not_kept() -> None:
    state: dict[str, Any] = {}
    kept = KeptLevels(2, 1.0, 0.1, state)
    for number, score in enumerate((0.2, 0.5, 0.1, 0.3)):
        kept.note(Level(number, 0.5), score, number)
    assert state["number"].tolist() == [3, 1]
    # A level that is kept takes its new score, even a lower one.
    kept.note(Level(1, 0.5), 0.0, 9)
    assert KeptLevels(2, 1.0, 0.1, state).scores.tolist() == [0.3, 0.0]


class Witness(BaseCallback):
    """Looks at the layouts on which worlds play, and scores each play of one by itself."""

    def __init__(self, venv: Any, levels: PrioritisedLevels) -> None:
        super().__init__()
        self.native = native(venv.env)
        self.levels = levels
        self.now: list[bytes] = []
        self.gains: list[list[float]] = [[] for _ in range(venv.num_envs)]
        self.scores: dict[bytes, float] = {}
        self.rollout: list[tuple[list[bytes], np.ndarray]] = []

    def layouts(self) -> list[bytes]:
        return [kind.tobytes() for kind in self.native.state["kind"]]

    def _on_rollout_start(self) -> None:
        self.now, self.rollout = self.layouts(), []

    def _on_step(self) -> bool:
        ended = self.locals["dones"] | (self.native.state["rounds_cleared"] > 0)
        self.rollout.append((self.now, ended))
        self.now = self.layouts()
        return True

    def _on_rollout_end(self) -> None:
        found = advantages(self.model)
        for (layouts, ended), gains in zip(self.rollout, found, strict=True):
            for world, gain in enumerate(gains):
                self.gains[world].append(abs(float(gain)))
                if ended[world]:
                    self.scores[layouts[world]] = float(np.mean(self.gains[world]))
                    self.gains[world] = []


def test_scores_belong_to_the_levels_that_worlds_play(tmp_path: Path) -> None:
    # So many seeds that none comes twice: two difficulties can give the same layout.
    changes = {"curriculum.stages": "[]", "curriculum.difficulty": "[0.5]"}
    experiment = small(tmp_path, **{**SEEDS, **changes, "env.levels": "seeds:100-999999"})
    venv = adapt(make_worlds(experiment, experiment.training.worlds))
    model = make_model(experiment, venv)
    state: dict[str, Any] = {}
    levels = PrioritisedLevels(experiment, venv, state)
    venv.set_options(levels.options())
    witness = Witness(venv, levels)
    model.learn(4096, callback=[levels, witness])
    kept = state[LEVELS]["kept"]
    assert kept["count"] > 20
    pairs = list(zip(kept["number"].tolist(), kept["difficulty"].tolist(), strict=True))
    for place in range(kept["count"]):
        seed, difficulty = pairs[place]
        assert 100 <= seed < 1_000_000
        assert 0 <= difficulty <= 0.5
        layout = generate_level(seed, difficulty=difficulty).kinds.tobytes()
        assert kept["score"][place] == pytest.approx(witness.scores[layout], rel=1e-5)
    venv.close()


def test_named_levels_are_rounds_and_stages_limit_them(tmp_path: Path) -> None:
    experiment = small(tmp_path, **ROUNDS)
    folder = RunFolder.create(experiment)
    train(experiment, folder)
    own = read_checkpoint(folder.checkpoint)["callbacks"][LEVELS]
    found = set(own["kept"]["number"][: own["kept"]["count"]].tolist())
    assert found <= set(range(1, 7))
    assert found > {1, 2, 3}
    assert (own["kept"]["difficulty"][: own["kept"]["count"]] == -1).all()


@pytest.mark.parametrize("changes", [SEEDS, ROUNDS])
def test_a_stopped_and_resumed_run_chooses_as_an_undisturbed_one(
    tmp_path: Path, changes: dict[str, str]
) -> None:
    changes = {**changes, "validation.every": "1024", "validation.episodes": "1"}
    experiment = small(tmp_path, **changes)
    whole, stopped = RunFolder.create(experiment), RunFolder.create(experiment)
    train(experiment, whole)
    first = []

    def stop_once(step: int, means: dict[str, float]) -> None:
        first.append(step)
        if len(first) == 1:
            signal.raise_signal(signal.SIGINT)

    assert train(experiment, stopped, on_measure=stop_once) == INTERRUPTED
    train(experiment, stopped, resumed=True)
    assert stopped.read_notes()["weights"] == whole.read_notes()["weights"]
    one, other = (read_checkpoint(run.checkpoint)["callbacks"][LEVELS] for run in (whole, stopped))
    for table, expected in ((one, other), (one["kept"], other["kept"])):
        for name, value in expected.items():
            if name != "kept":
                assert np.array_equal(table[name], value), name


def test_a_run_that_chooses_learns_otherwise_than_one_that_does_not(tmp_path: Path) -> None:
    hashes = set()
    for sampling in ("uniform", "value_loss", "positive_value_loss"):
        experiment = small(tmp_path, **{**SEEDS, "curriculum.sampling": sampling})
        folder = RunFolder.create(experiment)
        train(experiment, folder)
        hashes.add(folder.read_notes()["weights"])
    assert len(hashes) == 3


def forge(own: dict[str, Any], change: str) -> None:
    """Change a checkpoint's levels as no training does."""
    kept = own["kept"]
    if change == "score":
        kept["score"][0] = float("nan")
    elif change == "shape":
        kept["score"] = kept["score"][:5].clone()
    elif change == "count":
        kept["count"] = 10**6
    elif change == "seed":
        kept["number"][0] = 1_000_000
    elif change == "next":
        own["next_number"][0] = 1_000_000
    elif change == "difficulty":
        own["next_difficulty"][0] = 3.0
    elif change == "twice":
        kept["number"][1], kept["difficulty"][1] = kept["number"][0], kept["difficulty"][0]
    elif change == "key":
        own["more"] = 1
    elif change == "kept":
        own["kept"] = 7


@pytest.mark.parametrize(
    "change", ["score", "shape", "count", "seed", "next", "difficulty", "twice", "key", "kept"]
)
def test_forged_levels_are_refused(stopped: RunFolder, change: str) -> None:
    state = read_checkpoint(stopped.checkpoint)
    whole = stopped.checkpoint.read_bytes()
    forge(state["callbacks"][LEVELS], change)
    write_checkpoint(state, stopped.checkpoint)
    with pytest.raises(SettingsError, match="cannot be read"):
        train(stopped.experiment(), stopped, resumed=True)
    stopped.checkpoint.write_bytes(whole)


@pytest.fixture(scope="module")
def stopped(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    """Return a run that can be resumed."""
    changes = {**SEEDS, "validation.every": "1024", "validation.episodes": "1"}
    experiment = small(tmp_path_factory.mktemp("stopped"), **changes)
    folder = RunFolder.create(experiment)
    assert train(experiment, folder, on_measure=lambda step, means: INTERRUPTED) == INTERRUPTED
    return folder


def wrong(**changes: str) -> Experiment:
    return load_experiment("generalise", list(changes.items()))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"curriculum.sampling": "regret"}, "'value_loss'"),
        ({"env.levels": "test"}, "test seeds"),
        ({"env.levels": "seeds:5-1000000"}, "test seeds"),
        ({"curriculum.rounds": "[1, 2, 3]"}, "leave out"),
        ({"curriculum.temperature": "0"}, "above 0"),
        ({"curriculum.new_levels": "1.5"}, "at most 1"),
    ],
)
def test_what_cannot_be_chosen_is_refused(changes: dict[str, str], words: str) -> None:
    with pytest.raises(SettingsError, match=words):
        wrong(**{"curriculum.sampling": "value_loss", **changes})
