"""High scores, kept in a file of the player's."""

import json
from collections.abc import Mapping
from datetime import date
from pathlib import Path
from typing import Any, NamedTuple

from ..atomic import write_atomically
from ..config import Config
from ..reading import read_limited

MOST_KEPT = 10  # of one game
_LIMIT = 1 << 20  # bytes of the file
_MOST_GAMES = 500  # settings with scores; more would exceed the limit


class Score(NamedTuple):
    """How a game ended."""

    score: int
    round: int
    day: str  # as 2026-11-27


def game_name(config: Config, usual: Config, options: Mapping[str, Any]) -> str:
    """Return what distinguishes games whose scores can be compared with each other.

    Args:
        config: the game's configuration.
        usual: the configuration to which it is compared.
        options: how the game begins, as for `reset`.
    """
    ordinary = usual.plain()
    different = {key: value for key, value in config.plain().items() if value != ordinary[key]}
    given = {key: value for key, value in options.items() if value is not None}
    return json.dumps(different | given, sort_keys=True, default=str)


class Scores:
    """The best scores of each game, highest first.

    The file is read anew each time: another window may have written it.

    Args:
        path: of the file, which need not exist; None: scores are forgotten with this object.
    """

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._games: dict[str, list[Score]] = {}

    def best(self, game: str) -> list[Score]:
        """Return a game's scores; none if the file cannot be read."""
        try:
            return self._read().get(game, [])
        except (OSError, ValueError):
            return []

    def add(self, game: str, score: int, round_number: int) -> int | None:
        """Add a score; return its place, 0 for the highest, or None if it is not among the best.

        Raises:
            OSError, ValueError: the file cannot be read or written, and stays as it is.
        """
        games = self._read()
        kept = games.pop(game, [])
        place = sum(score <= other.score for other in kept)
        if score <= 0 or place >= MOST_KEPT:
            return None
        kept.insert(place, Score(score, round_number, date.today().isoformat()))
        # What was played last comes last: the longest unplayed games are forgotten first.
        games[game] = kept[:MOST_KEPT]
        self._write(dict(list(games.items())[-_MOST_GAMES:]))
        return place

    def _read(self) -> dict[str, list[Score]]:
        if self._path is None or not self._path.exists():
            return dict(self._games)
        try:
            content = json.loads(read_limited(self._path, _LIMIT))
            return {
                str(game): [Score(int(score), int(number), str(day)) for score, number, day in rows]
                for game, rows in content.items()
            }
        except (AttributeError, TypeError, ValueError, RecursionError) as error:
            raise ValueError(f"{self._path} holds no scores") from error

    def _write(self, games: dict[str, list[Score]]) -> None:
        self._games = games
        if self._path is not None:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            write_atomically(self._path, json.dumps(games, indent=1).encode())
