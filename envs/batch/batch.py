"""A batch of worlds and the one way to step it, whether it holds one world or ten thousand."""

import itertools
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels import inlined, kernel
from ..actions import COMMANDS, decode_actions, decode_velocities
from ..config import Config
from ..game.episode import begin_episode
from ..game.random import seed_state
from ..game.rulebook import make_rules
from ..game.tick import clear_events, decide
from ..levels.plan import LevelPlan, plan_levels
from ..levels.starts import choose_starts, forget_starts
from ..observe.choice import make_observer
from ..observe.protocol import Observe
from ..state import Outcome, World
from .setup import describe_setup

# By the kind of observation; a thread costs some 60 µs a step, and with fewer worlds brings less.
WORLDS_PER_THREAD = {"vector": 1024, "grid": 512, "rgb": 128}


class Autoreset(IntEnum):
    """What a step does with a world whose episode is over."""

    DISABLED = 0
    NEXT_STEP = 1  # the next step resets it, ignoring the action
    SAME_STEP = 2  # the same step resets it, and keeps the last observation and outcome apart


@kernel
def reset_worlds(worlds: Any, rules: Any, levels: Any, mask: Any, outcomes: Any) -> None:
    """Begin a new episode in the worlds of a mask (bool [n])."""
    for index in range(worlds.shape[0]):
        if mask[index]:
            _reset_world(worlds[index], rules[0], levels, outcomes[index])


@kernel
def _reset_world(world: Any, rules: Any, levels: Any, outcome: Any) -> None:
    """Begin a new episode in one world."""
    begin_episode(world, rules, levels)
    clear_events(world)
    outcome.reward = 0.0
    outcome.hits = 0
    outcome.terminated = False
    outcome.truncated = False
    outcome.truncation = 0
    _report(world, outcome)


@inlined
def _report(world: Any, outcome: Any) -> None:
    """Copy what `info` shows from the world to its outcome."""
    outcome.score = world.score
    outcome.lives = world.lives
    outcome.round_number = world.round_number
    outcome.bricks_left = world.bricks_left
    outcome.bricks_broken = world.bricks_broken
    outcome.capsules_caught = world.capsules_caught
    outcome.enemies_destroyed = world.enemies_destroyed
    outcome.lives_lost = world.lives_lost
    outcome.lives_gained = world.lives_gained
    outcome.rounds_cleared = world.rounds_cleared


@kernel
def step_worlds(
    worlds: Any, rules: Any, levels: Any, commands: Any, outcomes: Any, next_step: bool
) -> int:
    """Play one decision in each world; return how many episodes are over.

    Args:
        commands: float64 [n, 2], the velocity in [-1, 1] and fire (0 or 1).
        outcomes: `Outcome` records [n], written in place.
        next_step: whether a world whose episode was over before begins a new one instead.
    """
    over = 0
    for index in range(worlds.shape[0]):
        world, outcome = worlds[index], outcomes[index]
        if next_step and world.done:
            _reset_world(world, rules[0], levels, outcome)
            continue
        decide(world, rules[0], levels, commands[index, 0], commands[index, 1], outcome)
        _report(world, outcome)
        over += world.done
    return over


class Listener(Protocol):
    """Whoever is told of all that happens to a batch."""

    def reset(self, mask: NDArray[np.bool_]) -> None:
        """Hear that the worlds of a mask, bool [n], were reset."""

    def step(self) -> None:
        """Hear that a decision was played in each world."""

    def interrupt(self) -> None:
        """Hear that the worlds were brought into another state."""


@dataclass(frozen=True)
class _Share:
    """A thread's share of the worlds, with what its kernels take."""

    index: slice
    game: tuple[Any, ...]  # arguments of `step_worlds`
    everywhere: NDArray[np.bool_]
    observe: Observe


def _bytes_of(records: Any) -> NDArray[np.uint8]:
    """Return the bytes of records, uint8 [n, k]: copying records goes field by field."""
    view: NDArray[np.uint8] = records.view(np.uint8).reshape(len(records), -1)
    return view


def _copy_of(records: Any) -> Any:
    """Return a copy of records; NumPy's own takes 16 µs for one."""
    return np.frombuffer(bytearray(records.tobytes()), records.dtype)


class Batch:
    """Worlds that are played together, with the arrays that their steps read and write.

    Args:
        num_worlds: how many, at least 1.
        config: the rules they share.
        threads: how many threads step them at the most; None lets the batch's size decide.
        plan: the levels; None: those that the configuration names.

    Attributes:
        worlds: the state, `World` records [n].
        plan: the levels; rules: `Rules` [1]; levels: `Level` records.
        commands: float64 [n, 2], to be filled before `step`.
        outcomes: `Outcome` records [n], of the latest step.
        observer: what writes the observations.
        finals, final_observations: in same-step mode, those of the episodes that ended.
        listeners: that are told of every reset, step and restored state.
    """

    def __init__(
        self,
        num_worlds: int,
        config: Config,
        autoreset: Autoreset = Autoreset.DISABLED,
        threads: int | None = None,
        plan: LevelPlan | None = None,
    ) -> None:
        self.config = config
        self.autoreset = autoreset
        self.plan = plan_levels(config) if plan is None else plan
        self.rules = make_rules(config, self.plan)
        self.levels = self.plan.table
        self._table = COMMANDS.get(config.actions)
        self._threads = threads
        self.worlds = np.zeros(num_worlds, World)
        forget_starts(self.worlds)
        self.outcomes: Any = np.zeros(num_worlds, Outcome)
        self.observer = make_observer(config, num_worlds)
        self._prepare()

    def _prepare(self) -> None:
        """Make what else the worlds need to be stepped."""
        count = self.num_worlds
        self.commands: NDArray[np.float64] = np.zeros((count, 2))
        self.finals = _copy_of(self.outcomes)
        self.final_observations = np.zeros(self.observations.shape, self.observations.dtype)
        self.listeners: list[Listener] = []
        self._whole = self._share(0, count)
        self._shares = self._split(self._threads)
        self._pool: ThreadPoolExecutor | None = None

    def clone(self) -> "Batch":
        """Return an independent batch in the same state; nobody records it."""
        clone = object.__new__(Batch)
        clone.__dict__.update(self.__dict__)
        clone.worlds = _copy_of(self.worlds)
        clone.outcomes = _copy_of(self.outcomes)
        clone.observer = self.observer.clone()
        clone._prepare()
        return clone

    def __deepcopy__(self, memo: dict[int, Any]) -> "Batch":
        return self.clone()

    def __reduce__(self) -> tuple[Any, ...]:
        # Threads, and views of one another's memory, can't be pickled; they are made anew.
        arguments = (self.num_worlds, self.config, self.autoreset, self._threads, self.plan)
        return Batch, arguments, (self.worlds, self.outcomes, self.observations)

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        self.restore(*state)

    @property
    def num_worlds(self) -> int:
        """The number of worlds."""
        return len(self.worlds)

    @property
    def observations(self) -> NDArray[Any]:
        """The latest observations, [n, ...]."""
        return self.observer.observations

    @property
    def seeded(self) -> NDArray[np.bool_]:
        """Whether each world's generator was seeded, bool [n]; one that was is never zero."""
        seeded: NDArray[np.bool_] = self.worlds["random"] != 0
        return seeded

    @cached_property
    def setup(self) -> bytes:
        """What a state depends on besides itself, see `snapshots`."""
        return describe_setup(self.config, self.plan, self.rules, self.observations.dtype)

    def check_world(self, index: int | None) -> None:
        """Refuse the index of a world that is not there, with a ValueError; None is legal."""
        if index is not None and not 0 <= index < self.num_worlds:
            raise ValueError(f"world must be between 0 and {self.num_worlds - 1}; got {index!r}")

    def seed(self, index: int, seed: int) -> None:
        """Seed one world's generator."""
        self.worlds["random"][index] = seed_state(seed)

    def command(self, actions: Any) -> None:
        """Take actions as the worlds' commands: integers [n], or velocities and fire, [n, 2].

        Raises:
            ValueError: their number or one of them is illegal.
        """
        array = np.asarray(actions)
        if self._table is None:
            self._command_velocities(array)
            return
        if array.shape != (self.num_worlds,) or array.dtype.kind not in "iu":
            raise ValueError(
                f"actions must be {self.num_worlds} integers, one for each world; got "
                f"{array.dtype} of shape {array.shape}"
            )
        wrong = decode_actions(array.astype(np.int64), self._table, self.commands)
        if wrong >= 0:
            raise ValueError(
                f"action {array[wrong]} of world {wrong} is not in Discrete({len(self._table)})"
            )

    def _command_velocities(self, array: NDArray[Any]) -> None:
        if array.shape != (self.num_worlds, 2) or array.dtype.kind not in "iuf":
            raise ValueError(
                f"actions must be numbers of shape ({self.num_worlds}, 2), velocity and fire of "
                f"each world; got {array.dtype} of shape {array.shape}"
            )
        wrong = decode_velocities(array.astype(np.float64), self.commands)
        if wrong >= 0:
            raise ValueError(
                f"action {array[wrong].tolist()} of world {wrong} is not within -1 and 1"
            )

    def reset(self, mask: NDArray[np.bool_], options: dict[str, Any] | None = None) -> None:
        """Begin a new episode in the worlds of a mask, bool [n]; options: see `curriculum`."""
        if options:
            choose_starts(self.worlds, mask, options, self.config, self.plan)
        reset_worlds(self.worlds, self.rules, self.levels, mask, self.outcomes)
        self._whole.observe(mask)
        for listener in self.listeners:
            listener.reset(mask)

    def check_over(self, worlds: NDArray[np.uint8]) -> None:
        """Refuse worlds (their bytes) whose episode is over where there are none: a ValueError."""
        if self.autoreset is Autoreset.SAME_STEP and worlds.view(World)["done"].any():
            raise ValueError(
                "an episode is over in the snapshot, and with autoreset_mode='SameStep' the next "
                "one would have begun: restore it in an environment of another mode"
            )

    def restore(self, worlds: Any, outcomes: Any, observations: NDArray[Any]) -> None:
        """Go on from another state: records or their bytes, of each world or of one for all."""
        _bytes_of(self.worlds)[:] = _bytes_of(worlds)
        _bytes_of(self.outcomes)[:] = _bytes_of(outcomes)
        self.observer.recall(observations)
        for listener in self.listeners:
            listener.interrupt()

    def step(self) -> None:
        """Play one decision, as `commands` say, in each world, and observe it."""
        self._step_shares()
        for listener in self.listeners:
            listener.step()

    def _step_shares(self) -> None:
        self.observer.advance()
        shares = self._shares
        if len(shares) == 1:
            self._step(shares[0])
            return
        if self._pool is None:
            self._pool = ThreadPoolExecutor(len(shares) - 1, "arkanoid")
        # The kernels release the GIL; the calling thread takes a share, too.
        running = [self._pool.submit(self._step, share) for share in shares[1:]]
        self._step(shares[0])
        for task in running:
            task.result()

    def _step(self, share: _Share) -> None:
        over = step_worlds(*share.game)
        share.observe(share.everywhere)
        if over > 0 and self.autoreset is Autoreset.SAME_STEP:
            self._begin_again(share)

    def _begin_again(self, share: _Share) -> None:
        """Begin new episodes where they are over, and keep apart how those ended."""
        worlds, rules, levels, _, outcomes, _ = share.game
        over = worlds["done"] != 0
        ended = outcomes[over]
        self.finals[share.index][over] = ended
        self.final_observations[share.index][over] = self.observations[share.index][over]
        reset_worlds(worlds, rules, levels, over, outcomes)
        for field in ("reward", "terminated", "truncated"):
            outcomes[field][over] = ended[field]
        share.observe(over)

    def close(self) -> None:
        """End the threads; a later step starts them again."""
        if self._pool is not None:
            self._pool.shutdown()
            self._pool = None

    def _split(self, threads: int | None) -> list[_Share]:
        """Return each thread's share of the worlds."""
        if threads is None:
            worth = self.num_worlds // WORLDS_PER_THREAD[self.config.observation]
            threads = min(os.cpu_count() or 1, max(1, worth))
        if threads == 1:
            return [self._whole]
        bounds = np.linspace(0, self.num_worlds, min(threads, self.num_worlds) + 1).astype(int)
        return [self._share(start, stop) for start, stop in itertools.pairwise(bounds)]

    def _share(self, start: int, stop: int) -> _Share:
        index = slice(start, stop)
        return _Share(
            index,
            (
                self.worlds[index],
                self.rules,
                self.levels,
                self.commands[index],
                self.outcomes[index],
                self.autoreset is Autoreset.NEXT_STEP,
            ),
            np.ones(stop - start, np.bool_),
            self.observer.part(self.worlds, self.rules, index),
        )
