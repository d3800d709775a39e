"""Replays: recorded games as small files, from which each game can be played again bit for bit.

A replay holds what a game came from: the rules' keywords, the levels' bricks, the state of the
random generator when the game began, and the player's command in each decision. It is sealed
(`sealed`), with this content:

    4 bytes  length of what is next, unsigned, little-endian
    JSON     compressed with zlib: everything but the commands, see `Replay`
    commands compressed with zlib: one byte per command, its place in the JSON's ``palette`` of
             [velocity, fire]; or, where ``palette`` is null, float64 [decisions, 2] as sixteen
             planes of bytes
"""

import json
import re
import struct
import zlib
from dataclasses import asdict, dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels.sealed import seal, unseal
from ...version import __version__
from ..atomic import write_atomically
from ..checks import counted
from ..config import Config
from ..levels.plan import LevelPlan, check_layouts
from ..reading import read_limited
from ..rules import BRICK_LETTERS, CELLS, RULES_VERSION, TICKS_PER_SECOND
from ..state import GIVEN_LAYOUT, NOT_TRUNCATED, LevelEntry
from .headers import check_header

_MARK = b"ARKAPLAY"
_FORMAT = 1
_LENGTH = struct.Struct("<I")
# After this number of decisions, again and again, the checksum of the states is noted.
NOTE_EVERY = 256
_MOST_COLOURS = 256  # of the palette of commands
# Files may come from anyone: what they expand to has bounds.
MOST_DECISIONS = 10_000_000  # a week of play, without a pause
_MOST_TEXT = 1 << 24  # bytes of JSON
_MOST_BYTES = 1 << 28  # of a file: more than commands that nothing compresses, and the JSON
_VERSION = re.compile(r"[0-9A-Za-z.+!-]{1,64}")
# What reading raises where a file holds something else.
_ERRORS = (
    *(ArithmeticError, AttributeError, LookupError, RecursionError, TypeError),
    *(struct.error, zlib.error),
)

# How a game began: these fields of `World` say it.
_START_FIELDS = ("start", "start_round", "start_seed", "start_difficulty", "start_boss")


@dataclass(frozen=True)
class Result:
    """The result of a recorded game.

    Attributes:
        decisions: how many were played.
        reward: the sum of their rewards.
        score, lives, round: at the end.
        terminated: whether the last life was lost.
        truncation: why the game was truncated, see `state`; 0 if it was not.
    """

    decisions: int
    reward: float
    score: int
    lives: int
    round: int
    terminated: bool
    truncation: int


@dataclass(frozen=True)
class GameStart:
    """How a game began.

    Attributes:
        random: the state of the random generator.
        fields: those of `World` that say where the first round comes from.
        layout: the bricks of a given first round, in a level file's letters.
    """

    random: int
    fields: dict[str, float]
    layout: str

    @classmethod
    def of(cls, world: Any) -> "GameStart":
        """Return how the present game of a world (a `World` record) began."""
        fields = {name: world[name].item() for name in _START_FIELDS}
        return cls(int(world["first_random"]), fields, _letters(world["start_kind"]))

    def apply(self, worlds: Any) -> None:
        """Let the next games of worlds (`World` [n]) begin like this."""
        worlds["random"] = self.random
        for name, value in self.fields.items():
            worlds[name] = value
        worlds["start_kind"] = _kinds(self.layout)


@dataclass(frozen=True)
class Replay:
    """A recorded game.

    Attributes:
        config: the keywords of the game, without those of its observation.
        plan: its levels.
        start: how it began.
        commands: velocity in [-1, 1] and fire of each decision, float64 [decisions, 2].
        checksums: of states during the game, see `recorder`.
        result: how it ended.
        version: of the release that recorded it.
    """

    config: Config
    plan: LevelPlan
    start: GameStart
    commands: NDArray[np.float64]
    checksums: tuple[int, ...]
    result: Result
    version: str = __version__

    @property
    def frames_per_second(self) -> float:
        """The number of frames in one second of the game."""
        return TICKS_PER_SECOND / self.config.frame_skip

    def save(self, path: str | PathLike[str]) -> None:
        """Write a file, replacing one of the same name: all of it, or the old one stays.

        Raises:
            OSError: it can't be written.
            ValueError: the game is too long, see `MOST_DECISIONS`.
        """
        write_atomically(Path(path), self.to_bytes())

    @classmethod
    def load(cls, path: str | PathLike[str]) -> "Replay":
        """Read a file.

        Raises:
            OSError: it can't be read.
            ValueError: it is not a replay, corrupt, or of another version of the format or the
                rules; the message names the file.
        """
        try:
            return cls.from_bytes(read_limited(Path(path), _MOST_BYTES))
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from error

    def to_bytes(self) -> bytes:
        """Return what a file holds.

        Raises:
            ValueError: the game is too long, see `MOST_DECISIONS`.
        """
        _check_length(len(self.commands))
        palette, commands = _pack_commands(self.commands)
        head = {
            "version": self.version,
            "rules": RULES_VERSION,
            "config": self.config.plain(),
            "levels": plain_plan(self.plan),
            "start": asdict(self.start),
            "result": asdict(self.result),
            "checksums": self.checksums,
            "palette": palette,
        }
        text = zlib.compress(json.dumps(head, separators=(",", ":")).encode(), 9)
        return seal(_MARK, _FORMAT, _LENGTH.pack(len(text)) + text + _compress(commands))

    @classmethod
    def from_bytes(cls, data: bytes) -> "Replay":
        """Return the replay of a file's bytes.

        Raises:
            TypeError: they are no bytes.
            ValueError: as `load`.
        """
        content = unseal("replay", _MARK, _FORMAT, data)
        try:
            return cls._read(content)
        except _ERRORS as error:
            raise ValueError("the replay is corrupt: it lacks what a replay holds") from error

    @classmethod
    def _read(cls, content: memoryview) -> "Replay":
        """Return the replay of a content; raise ValueError or one of `_ERRORS` if it is none."""
        (length,) = _LENGTH.unpack_from(content)
        text = content[_LENGTH.size :]
        head = _read_json(_expand(text[:length], _MOST_TEXT))
        if not _VERSION.fullmatch(head["version"]) or type(head["rules"]) is not int:
            raise ValueError("the replay is corrupt: it does not say which release recorded it")
        if head["rules"] != RULES_VERSION:
            raise ValueError(
                f"the replay is of the rules' version {head['rules']}, recorded with release "
                f"{head['version']}, and this release ({__version__}) plays version "
                f"{RULES_VERSION}: play it with the release that recorded it"
            )
        check_header(head)
        result = Result(**head["result"])
        _check_length(result.decisions)
        size = result.decisions * (16 if head["palette"] is None else 1)
        packed = _expand(text[length:], size)
        if len(packed) != size:
            raise ValueError("the replay is corrupt: its commands are not those of its decisions")
        replay = cls(
            config=Config.from_keywords(head["config"]),
            plan=_read_plan(head["levels"]),
            start=GameStart(**head["start"]),
            commands=_unpack_commands(head["palette"], packed),
            checksums=tuple(head["checksums"]),
            result=result,
            version=head["version"],
        )
        replay._check()
        return replay

    def _check(self) -> None:
        """Raise a ValueError for what no player could have done: files may come from anyone."""
        if self.config != self.config.of_the_game():
            raise ValueError("the replay is corrupt: it says how the game is seen; none does")
        self._check_checksums()
        move, fire = self.commands.T
        illegal = ~((abs(move) <= 1.0) & ((fire == 0.0) | (fire == 1.0)))  # so that NaN is, too
        if illegal.any():
            decision = int(illegal.argmax())
            raise ValueError(f"the command {self.commands[decision]} is illegal")
        fields, plan = self.start.fields, self.plan
        layout = np.array([_kinds(self.start.layout)], np.uint8)
        if fields["start"] == GIVEN_LAYOUT:
            check_layouts(layout, np.array([fields["start_boss"] == 1]), self.config.enemies)
        if not plan.seeds or len(plan.table) != max(1, len(plan.names)):
            raise ValueError("no game has such levels")
        if plan.names:
            check_layouts(plan.table["kind"], plan.table["boss"], self.config.enemies)

    def _check_checksums(self) -> None:
        """Raise a ValueError unless there are as many checksums as a recorder notes."""
        result = self.result
        # The result of a game that is over takes the place of its last state's checksum.
        over = result.terminated or result.truncation != NOT_TRUNCATED
        noted = 1 + max(0, result.decisions - over) // NOTE_EVERY
        if len(self.checksums) != noted + 1:  # and the last one
            raise ValueError(
                f"the replay is corrupt: it has {counted(len(self.checksums), 'checksum')}, and a "
                f"game of {counted(result.decisions, 'decision')} has {noted + 1}"
            )


def _read_json(text: bytes) -> Any:
    """Return what JSON says."""
    try:
        return json.loads(text.decode())
    except ValueError as error:
        raise ValueError(f"the replay is corrupt: no JSON in UTF-8: {error}") from error


def _check_length(decisions: int) -> None:
    """Raise a ValueError if a file can't hold so many decisions."""
    if type(decisions) is not int or not 0 <= decisions <= MOST_DECISIONS:
        raise ValueError(f"a replay has at most {MOST_DECISIONS:,} decisions; got {decisions!r}")


def _expand(packed: memoryview, most: int) -> bytes:
    """Return what was compressed; raise a ValueError if it is more than so many bytes."""
    expander = zlib.decompressobj()
    content = expander.decompress(packed, most + 1)
    if len(content) > most or not expander.eof or expander.unused_data:
        raise ValueError(f"the replay is corrupt: a part of it has not its {most:,} bytes or less")
    return content


def _compress(commands: bytes) -> bytes:
    # A player's commands repeat in long runs; to look for short ones makes files larger.
    compressor = zlib.compressobj(level=9, strategy=zlib.Z_FILTERED)
    return compressor.compress(commands) + compressor.flush()


def _letters(kinds: NDArray[np.uint8]) -> str:
    """Return a layout, uint8 [cells], as letters, without the empty cells at the end."""
    return "".join(BRICK_LETTERS[kind] for kind in kinds).rstrip(BRICK_LETTERS[0])


def _kinds(letters: str) -> list[int]:
    """Return the layout that `_letters` wrote."""
    if len(letters) > CELLS or not set(letters) <= set(BRICK_LETTERS):
        raise ValueError(f"a layout is at most {CELLS} of the letters {BRICK_LETTERS!r}")
    return [BRICK_LETTERS.index(letter) for letter in letters.ljust(CELLS, BRICK_LETTERS[0])]


def plain_plan(plan: LevelPlan) -> dict[str, Any]:
    """Return a plan as JSON holds it."""
    return {
        "names": plan.names,
        "bricks": [_letters(level["kind"]) for level in plan.table],
        "boss": plan.table["boss"].tolist(),
        "seeds": [plan.seeds.start, plan.seeds.stop],
        "endless": plan.endless,
        "first_difficulty": plan.first_difficulty,
    }


def _read_plan(plain: dict[str, Any]) -> LevelPlan:
    """Return the plan that `plain_plan` wrote."""
    if len(plain["boss"]) != len(plain["bricks"]):  # NumPy would repeat a single one
        raise ValueError("no game has such levels")
    table = np.zeros(len(plain["bricks"]), LevelEntry)
    table["kind"] = [_kinds(letters) for letters in plain["bricks"]]
    table["boss"] = plain["boss"]
    return LevelPlan(
        names=tuple(plain["names"]),
        table=table,
        seeds=range(*plain["seeds"]),
        endless=plain["endless"],
        first_difficulty=plain["first_difficulty"],
    )


def _pack_commands(commands: NDArray[np.float64]) -> tuple[list[list[float]] | None, bytes]:
    """Return the palette of commands, float64 [n, 2], and their bytes; see the head of the file."""
    # By their bits, because -0.0 and 0.0 are different commands.
    bits, places = np.unique(commands.view(np.uint64), axis=0, return_inverse=True)
    if len(bits) <= _MOST_COLOURS:
        return bits.view(np.float64).tolist(), places.astype(np.uint8).tobytes()
    return None, np.ascontiguousarray(commands.view(np.uint8).reshape(-1, 16).T).tobytes()


def _unpack_commands(palette: list[list[float]] | None, packed: bytes) -> NDArray[np.float64]:
    array = np.frombuffer(packed, np.uint8)
    if palette is not None:
        # Of at least one command, because none is no array of two columns.
        return np.array(palette or [[0.0, 0.0]], np.float64).reshape(-1, 2)[array]
    return np.ascontiguousarray(array.reshape(16, -1).T).view(np.float64)
