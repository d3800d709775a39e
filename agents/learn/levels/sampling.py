"""The curriculum that makes itself: each world's next level is one that promises most to learn."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....envs.levels.plan import campaign_names, seed_range
from ....envs.levels.starts import MAX_ROUND
from ...adapter import GymnasiumVecEnv
from ...experiment.seeds import Purpose, spread_seed
from ...experiment.settings import Experiment
from ...experiment.worlds import native
from ..stages import Stages
from .kept import KeptLevels, Level, check_columns

# The key of `PrioritisedLevels` in the callbacks' state.
LEVELS = "levels"
_KEPT = "kept"


def make_stages(experiment: Experiment, venv: GymnasiumVecEnv, state: dict[str, Any]) -> Stages:
    """Return the callback that follows an experiment's ``[curriculum]``."""
    is_uniform = experiment.curriculum.sampling == "uniform"
    return (Stages if is_uniform else PrioritisedLevels)(experiment, venv, state)


def check_levels(state: dict[str, Any], experiment: Experiment) -> None:
    """Raise ValueError unless the callbacks' state has what `make_stages` left in it."""
    if experiment.curriculum.sampling == "uniform":
        if LEVELS in state:
            raise ValueError("it chooses levels, and this run does not")
        return
    own: Any = state.get(LEVELS)
    fresh = _fresh(experiment, experiment.training.worlds)
    kept: Any = own.get(_KEPT) if isinstance(own, dict) else None
    check_columns(kept, fresh.pop(_KEPT), f"{LEVELS}.{_KEPT}")
    check_columns({**own, _KEPT: 0}, {**fresh, _KEPT: 0}, LEVELS)
    if kept["count"] > experiment.curriculum.kept_levels:
        raise ValueError(f"{LEVELS}.{_KEPT}.count is too large")
    pairs = zip(kept["number"].tolist(), kept["difficulty"].tolist(), strict=True)
    found = list(pairs)[: kept["count"]]
    if len(set(found)) != len(found):
        raise ValueError(f"{LEVELS}.{_KEPT} has a level twice")
    # A forged one could train on the test's seeds.
    legal = seed_range(experiment.config.levels) or range(1, MAX_ROUND + 1)
    numbers = [*(number for number, _ in found), *own["next_number"].tolist()]
    if not all(number in legal for number in numbers):
        raise ValueError(f"{LEVELS} has levels that this run does not play")


class PrioritisedLevels(Stages):
    """Chooses for each world the level that it plays next: a new one, or one with a high score.

    A level's score is the mean of its decisions' advantages, their magnitudes or their positive
    parts: both are large where the value function is wrong, so where there is something to learn.
    The stages of the curriculum limit new levels as they do without scores.

    With generated levels (``env.levels`` names seeds) it chooses a seed and a difficulty for each
    game and each further round. With named levels it chooses the round in which a game begins; the
    rounds after it follow as always, and have scores of their own.

    A world gets its choice one level ahead, because worlds restart by themselves.

    Args:
        experiment: see `Stages`.
        venv: the native environment that is trained on.
        state: this callback's, empty or from a checkpoint; it is changed in place.
    """

    def __init__(
        self, experiment: Experiment, venv: GymnasiumVecEnv, state: dict[str, Any]
    ) -> None:
        super().__init__(experiment, venv, state)
        curriculum = experiment.curriculum
        self._own = state.setdefault(LEVELS, _fresh(experiment, venv.num_envs))
        for table in (self._own, self._own[_KEPT]):
            table.update({k: v.numpy().copy() for k, v in table.items() if hasattr(v, "numpy")})
        self._kept = KeptLevels(
            curriculum.kept_levels, curriculum.temperature, curriculum.staleness, self._own[_KEPT]
        )
        self._seed = spread_seed(experiment.seed, Purpose.LEVELS)
        self._config = experiment.config
        self._seeds = seed_range(experiment.config.levels)
        self._native = native(venv.env)
        # Of this rollout: its plays of levels, the one of each world, and that of each decision.
        self._plays: list[Level] = []
        self._ended: list[int] = []
        self._playing = np.zeros(venv.num_envs, np.int64)
        self._of_decisions: list[NDArray[np.int64]] = []

    def options(self) -> list[dict[str, Any]]:
        """Draw levels for all worlds; return the options of a reset that begins them."""
        levels = self._draw(self._venv.num_envs)
        self._set("current", levels)
        # The next ones are drawn when the worlds have begun.
        self._own["is_ready"] = 0
        return [
            {**of_stage, **self._start(level)}
            for of_stage, level in zip(super().options(), levels, strict=True)
        ]

    def _on_rollout_start(self) -> None:
        super()._on_rollout_start()
        worlds = self._venv.num_envs
        if not self._own["is_ready"]:
            self._own["sums"][:] = 0
            self._own["decisions"][:] = 0
            self._choose_next(np.arange(worlds))
            self._own["is_ready"] = 1
        self._plays = self._levels("current")
        self._playing = np.arange(worlds)
        self._ended, self._of_decisions = [], []

    def _on_step(self) -> bool:
        self._of_decisions.append(self._playing.copy())
        state = self._native.state
        begun = state["decisions"] == 0
        cleared = (state["rounds_cleared"] > 0) & ~begun
        if not (begun | cleared).any():
            return True
        # Of generated levels every round is chosen, of named ones only the first.
        chosen = begun if self._seeds is None else begun | cleared
        follow = np.flatnonzero(cleared & ~chosen)
        takers = np.flatnonzero(chosen)
        following = self._levels("next")
        self._begin(takers, [following[world] for world in takers])
        rounds = state["round_number"][follow].tolist()
        self._begin(follow, [Level(number, -1.0) for number in rounds])
        if takers.size:
            self._choose_next(takers)
        return True

    def _on_rollout_end(self) -> None:
        gains = advantages(self.model)
        is_positive = self._curriculum.sampling == "positive_value_loss"
        values = np.maximum(gains, 0) if is_positive else np.abs(gains)
        plays = np.concatenate(self._of_decisions)
        sums = np.bincount(plays, values.ravel().astype(np.float64), len(self._plays))
        counts = np.bincount(plays, minlength=len(self._plays))
        sums[: len(self._playing)] += self._own["sums"]
        counts[: len(self._playing)] += self._own["decisions"]
        for play in self._ended:
            level = self._plays[play]
            if self._is_choosable(level):
                self._kept.note(level, float(sums[play] / counts[play]), self._own["draws"])
        self._own["sums"][:] = sums[self._playing]
        self._own["decisions"][:] = counts[self._playing]
        self._set("current", [self._plays[play] for play in self._playing])
        self.logger.record("levels/kept", len(self._kept))
        if len(self._kept):
            self.logger.record("levels/score_mean", float(self._kept.scores.mean()))
            self.logger.record("levels/score_max", float(self._kept.scores.max()))

    def _begin(self, worlds: NDArray[np.int64], levels: list[Level]) -> None:
        """Note that worlds begin levels, one each, with their next decision."""
        self._ended += self._playing[worlds].tolist()
        self._playing[worlds] = len(self._plays) + np.arange(len(levels))
        self._plays += levels

    def _choose_next(self, worlds: NDArray[np.int64]) -> None:
        """Draw the next levels of worlds, and tell the environment."""
        levels = self._draw(len(worlds))
        for world, level in zip(worlds.tolist(), levels, strict=True):
            self._own["next_number"][world], self._own["next_difficulty"][world] = level
            self._native.set_start(world, self._start(level))

    def _draw(self, count: int) -> list[Level]:
        """Return levels to be played: new ones, and kept ones by their probabilities."""
        # A generator for each call: a checkpoint keeps nothing of it but the counter.
        counter = self._own["draws"] << 64
        random = np.random.Generator(np.random.Philox(key=self._seed, counter=counter))
        is_new = random.random(count) < self._curriculum.new_levels
        uniform = random.random(count)
        new = self._new(random, count)
        if len(self._kept) and not is_new.all():
            again = self._kept.draw(uniform[~is_new], self._own["draws"])
            for place, level in zip(np.flatnonzero(~is_new), again, strict=True):
                new[place] = level
        self._own["draws"] += count
        return new

    def _new(self, random: np.random.Generator, count: int) -> list[Level]:
        """Return levels as a training without scores plays them."""
        if self._seeds is None:
            rounds = random.integers(1, self._last_round, count, endpoint=True)
            return [Level(number, -1.0) for number in rounds.tolist()]
        seeds = random.integers(self._seeds.start, self._seeds.stop, count)
        parts = random.random(count)
        return [
            Level(seed, self._difficulty(part))
            for seed, part in zip(seeds.tolist(), parts.tolist(), strict=True)
        ]

    def _difficulty(self, part: float) -> float:
        """Return the difficulty of a new level at a part of the way to the hardest."""
        if self._curriculum.difficulty:
            return part * self._curriculum.difficulty[self._stage]
        return part if self._config.difficulty is None else self._config.difficulty

    @property
    def _last_round(self) -> int:
        """The last of the rounds in which games may begin."""
        if self._curriculum.rounds:
            return self._curriculum.rounds[self._stage]
        levels = self._config.levels
        if levels == "campaign":
            return len(campaign_names(self._config))
        return 1 if isinstance(levels, str) else len(levels)

    def _is_choosable(self, level: Level) -> bool:
        return self._seeds is not None or level.number <= self._last_round

    def _start(self, level: Level) -> dict[str, Any]:
        """Return the environment's options that begin a level."""
        if self._seeds is None:
            return {"level": level.number}
        return {"seed": level.number, "difficulty": level.difficulty, "repeat": True}

    def _levels(self, which: str) -> list[Level]:
        """Return the present or the next level of each world."""
        numbers = self._own[f"{which}_number"].tolist()
        difficulties = self._own[f"{which}_difficulty"].tolist()
        return list(map(Level, numbers, difficulties))

    def _set(self, which: str, levels: list[Level]) -> None:
        numbers, difficulties = zip(*levels, strict=True)
        self._own[f"{which}_number"][:] = numbers
        self._own[f"{which}_difficulty"][:] = difficulties


def advantages(model: Any) -> NDArray[np.floating[Any]]:
    """Return the advantages of a model's latest rollout, [steps, worlds], at the rollout's end."""
    rollout = getattr(model, "rollout", None)
    if rollout is not None:
        gains: NDArray[np.float32] = rollout.returns - rollout.values[:-1]
        return gains
    buffered: NDArray[np.float32] = model.rollout_buffer.advantages
    return buffered


def _fresh(experiment: Experiment, worlds: int) -> dict[str, Any]:
    """Return the state before the first level."""
    curriculum = experiment.curriculum
    kept: dict[str, Any] = {}
    KeptLevels(curriculum.kept_levels, curriculum.temperature, curriculum.staleness, kept)
    return {
        _KEPT: kept,
        "draws": 0,
        "is_ready": 0,
        **{f"{which}_number": np.zeros(worlds, np.int64) for which in ("current", "next")},
        **{f"{which}_difficulty": np.zeros(worlds) for which in ("current", "next")},
        "sums": np.zeros(worlds),
        "decisions": np.zeros(worlds, np.int64),
    }
