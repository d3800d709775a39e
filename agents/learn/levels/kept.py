"""Levels that a training has played, their scores, and which of them it plays again.

The rules are those of Jiang, Grefenstette and Rocktäschel (2021), "Prioritized Level Replay".
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

# The type of each column.
_COLUMNS = {"number": np.int64, "difficulty": np.float64, "score": np.float64, "drawn": np.int64}


class Level(NamedTuple):
    """A level.

    Attributes:
        number: a generator's seed, or the number of a round.
        difficulty: of a generated level; -1 for a round.
    """

    number: int
    difficulty: float


class KeptLevels:
    """The levels with the highest scores of those that were played.

    Args:
        size: how many are kept at most.
        temperature: a level is played again with a probability that falls with the rank of its
            score as ``rank ** (-1 / temperature)``.
        staleness: the part of the probability that grows instead with the time since a level was
            drawn, so that scores do not become too old.
        state: empty, or what another object of the same size left in it; it is changed in place.
    """

    def __init__(
        self, size: int, temperature: float, staleness: float, state: dict[str, Any]
    ) -> None:
        self._temperature = temperature
        self._staleness = staleness
        self._state = state
        for name, kind in _COLUMNS.items():
            state.setdefault(name, np.zeros(size, kind))
        state.setdefault("count", 0)
        levels = zip(state["number"].tolist(), state["difficulty"].tolist(), strict=True)
        known = list(levels)[: state["count"]]
        self._places = {Level(*level): place for place, level in enumerate(known)}

    def __len__(self) -> int:
        return int(self._state["count"])

    @property
    def scores(self) -> NDArray[np.float64]:
        """The score of each level."""
        scores: NDArray[np.float64] = self._column("score")
        return scores

    def probabilities(self, clock: int) -> NDArray[np.float64]:
        """Return the probability of each level to be played again.

        ``clock`` counts all levels that were drawn so far, new ones included.
        """
        order = np.argsort(-self.scores, kind="stable")
        ranks = np.empty(len(self))
        ranks[order] = np.arange(1, len(self) + 1)
        by_score = ranks ** (-1 / self._temperature)
        ages = clock - self._column("drawn").astype(np.float64)
        by_age = ages / ages.sum() if ages.sum() > 0 else np.full(len(self), 1 / len(self))
        ranked: NDArray[np.float64] = by_score / by_score.sum()
        chances: NDArray[np.float64] = (1 - self._staleness) * ranked + self._staleness * by_age
        return chances

    def draw(self, uniform: NDArray[np.float64], clock: int) -> list[Level]:
        """Return a level for each of some uniform random numbers in [0, 1)."""
        bounds = np.cumsum(self.probabilities(clock))
        places = np.minimum(np.searchsorted(bounds, uniform, side="right"), len(self) - 1)
        self._column("drawn")[places] = clock
        numbers, difficulties = self._column("number"), self._column("difficulty")
        return [Level(int(numbers[place]), float(difficulties[place])) for place in places]

    def note(self, level: Level, score: float, clock: int) -> None:
        """Note the score of a level that was played; if there are too many, drop the lowest."""
        place = self._places.get(level)
        if place is None:
            place = self._place_for(score)
            if place is None:
                return
            self._places[level] = place
            self._column("number")[place] = level.number
            self._column("difficulty")[place] = level.difficulty
            self._column("drawn")[place] = clock
        self._column("score")[place] = score

    def _place_for(self, score: float) -> int | None:
        """Return a free place for a level, or that of a level with a lower score."""
        state = self._state
        if state["count"] < len(state["score"]):
            state["count"] += 1
            return int(state["count"]) - 1
        lowest = int(np.argmin(self.scores))
        if self.scores[lowest] >= score:
            return None
        dropped = Level(int(state["number"][lowest]), float(state["difficulty"][lowest]))
        del self._places[dropped]
        return lowest

    def _column(self, name: str) -> NDArray[Any]:
        return np.asarray(self._state[name][: self._state["count"]])


def check_columns(state: Mapping[str, Any], fresh: Mapping[str, Any], where: str) -> None:
    """Raise ValueError unless arrays and numbers have the form of fresh ones, and are sensible.

    Arrays may be tensors. Numbers are at least 0; difficulties are at most 1, and -1 for rounds.
    """
    if not isinstance(state, dict) or state.keys() != fresh.keys():
        raise ValueError(f"{where} has other entries than a checkpoint of this run")
    for name, like in fresh.items():
        value = state[name]
        least, most = (-1, 1) if "difficulty" in name else (0, 2**63 - 1)
        if isinstance(like, np.ndarray):
            array = value.numpy() if hasattr(value, "numpy") else value
            alike = (
                isinstance(array, np.ndarray)
                and array.dtype == like.dtype
                and array.shape == like.shape
            )
            sensible = alike and bool(((array >= least) & (array <= most)).all())
        else:
            sensible = type(value) is int and least <= value < 2**62
        if not sensible:
            raise ValueError(f"{where}.{name} is not that of this run")
