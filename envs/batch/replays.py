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
from ..config import Config
from ..levels.generator import MAX_SEED
from ..levels.plan import LevelPlan
from ..levels.starts import MAX_ROUND
from ..rules import BRICK_LETTERS, CELLS, RULES_VERSION, TICKS_PER_SECOND
from ..state import AS_CONFIGURED, GIVEN_LAYOUT, GIVEN_SEED, LevelEntry

_MARK = b"ARKAPLAY"
_FORMAT = 1
_LENGTH = struct.Struct("<I")
_MOST_COLOURS = 256  # of the palette of commands

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
        """Write a file, replacing one of the same name."""
        Path(path).write_bytes(self.to_bytes())

    @classmethod
    def load(cls, path: str | PathLike[str]) -> "Replay":
        """Read a file.

        Raises:
            OSError: it can't be read.
            ValueError: it is not a replay, corrupt, or of another version of the format or the
                rules; the message names the file.
        """
        try:
            return cls.from_bytes(Path(path).read_bytes())
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from error

    def to_bytes(self) -> bytes:
        """Return what a file holds."""
        palette, commands = _pack_commands(self.commands)
        head = {
            "version": self.version,
            "rules": RULES_VERSION,
            "config": self.config.plain(),
            "levels": _plain_plan(self.plan),
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
        (length,) = _LENGTH.unpack_from(content)
        head = json.loads(zlib.decompress(content[_LENGTH.size :][:length]))
        if head["rules"] != RULES_VERSION:
            raise ValueError(
                f"the replay is of the rules' version {head['rules']}, recorded with release "
                f"{head['version']}, and this release ({__version__}) plays version "
                f"{RULES_VERSION}: play it with the release that recorded it"
            )
        commands = zlib.decompress(content[_LENGTH.size + length :])
        replay = cls(
            config=Config.from_keywords(head["config"]),
            plan=_read_plan(head["levels"]),
            start=GameStart(**head["start"]),
            commands=_unpack_commands(head["palette"], commands),
            checksums=tuple(head["checksums"]),
            result=Result(**head["result"]),
            version=head["version"],
        )
        replay._check()
        return replay

    def _check(self) -> None:
        """Raise a ValueError for what no player could have done: files may come from anyone."""
        move, fire = self.commands.T
        illegal = ~((abs(move) <= 1.0) & ((fire == 0.0) | (fire == 1.0)))  # so that NaN is, too
        if illegal.any():
            decision = int(illegal.argmax())
            raise ValueError(f"the command {self.commands[decision]} is illegal")
        fields, seeds = self.start.fields, self.plan.seeds
        if tuple(fields) != _START_FIELDS or not (
            0 < self.start.random < 1 << 64
            and fields["start"] in (AS_CONFIGURED, GIVEN_LAYOUT, GIVEN_SEED)
            and 1 <= fields["start_round"] <= MAX_ROUND
            and 0 <= fields["start_seed"] <= MAX_SEED
            and -1.0 <= fields["start_difficulty"] <= 1.0
            and fields["start_boss"] in (0, 1)
        ):
            raise ValueError(f"no game begins like this: {self.start}")
        if not (0 <= seeds.start < seeds.stop <= MAX_SEED + 1 and len(self.plan.table)):
            raise ValueError("no game has such levels")


def _compress(commands: bytes) -> bytes:
    # A player's commands repeat in long runs; to look for short ones makes files larger.
    compressor = zlib.compressobj(level=9, strategy=zlib.Z_FILTERED)
    return compressor.compress(commands) + compressor.flush()


def _letters(kinds: NDArray[np.uint8]) -> str:
    """Return a layout, uint8 [cells], as letters, without the empty cells at the end."""
    return "".join(BRICK_LETTERS[kind] for kind in kinds).rstrip(BRICK_LETTERS[0])


def _kinds(letters: str) -> list[int]:
    """Return the layout that `_letters` wrote."""
    return [BRICK_LETTERS.index(letter) for letter in letters.ljust(CELLS, BRICK_LETTERS[0])]


def _plain_plan(plan: LevelPlan) -> dict[str, Any]:
    return {
        "names": plan.names,
        "bricks": [_letters(level["kind"]) for level in plan.table],
        "boss": plan.table["boss"].tolist(),
        "seeds": [plan.seeds.start, plan.seeds.stop],
        "endless": plan.endless,
        "first_difficulty": plan.first_difficulty,
    }


def _read_plan(plain: dict[str, Any]) -> LevelPlan:
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
        return np.array(palette, np.float64).reshape(-1, 2)[array]
    return np.ascontiguousarray(array.reshape(16, -1).T).view(np.float64)
