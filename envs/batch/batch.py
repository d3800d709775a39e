"""A batch of worlds and the one way to step it, whether it holds one world or ten thousand."""

import itertools
from collections.abc import Iterator, Sequence
from enum import IntEnum
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.kernels.one_thread import OneThread
from ...physics.kernels.threads import Threads
from ..actions import (
    BOX,
    COMMANDS,
    as_float32,
    decode_actions,
    decode_velocities,
    read_array,
)
from ..checks import check_integer
from ..config import Config
from ..game.random import seed_state
from ..game.rulebook import make_rules
from ..levels.plan import LevelPlan, plan_levels
from ..levels.starts import AS_THE_CONFIGURATION_SAYS, read_start, set_starts
from ..observe.choice import make_observer
from ..state import GAME_OVER, Outcome, Outcomes, World, Worlds, copy_records, zeros_in_lines
from .blocks import Block, divide, thread_count
from .listeners import Listeners
from .refusal import why_refused
from .setup import describe_setup
from .stepping import reset_worlds, step_worlds


class Autoreset(IntEnum):
    """What a step does with a world whose episode is over."""

    DISABLED = 0
    NEXT_STEP = 1  # the next step resets it, ignoring the action
    SAME_STEP = 2  # the same step resets it, and keeps the last observation and outcome apart


def _bytes_of(records: Any) -> NDArray[np.uint8]:
    """Return the bytes of records, uint8 [n, k]: copying records goes field by field."""
    view: NDArray[np.uint8] = records.view(np.uint8).reshape(len(records), -1)
    return view


class Batch:
    """Worlds that are played together, with the arrays that their steps read and write.

    It belongs to one thread at a time: a call while another one is in progress gets a RuntimeError.

    Args:
        num_worlds: how many, at least 1.
        config: the rules they share.
        threads: the largest number of threads that step them; None lets the batch's size decide.
        plan: the levels; None: those that the configuration names.

    Attributes:
        worlds: the state, `World` records [n].
        plan: the levels, and which of them follow each other.
        rules: of all worlds.
        levels: those of the plan that are played in turn.
        commands: float64 [n, 2], to be filled before `step`.
        outcomes: `Outcome` records [n], of the latest step.
        observer: what writes the observations.
        finals, final_observations: in same-step mode, those of the episodes that ended.
        listeners: they are told of every reset, step and restored state.
        alone: it refuses other calls while one is in progress.
        changes: how many of these have begun; after each the listeners are told, unless it is
            interrupted.
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
        self._most_threads = threads
        self.worlds: Worlds = zeros_in_lines((num_worlds,), World)
        set_starts(self.worlds, np.ones(num_worlds, np.bool_), AS_THE_CONFIGURATION_SAYS)
        self.outcomes: Outcomes = zeros_in_lines((num_worlds,), Outcome)
        self.observer = make_observer(config, num_worlds)
        self._prepare()

    def _prepare(self) -> None:
        """Make everything else that stepping needs."""
        count = self.num_worlds
        self.commands: NDArray[np.float64] = np.zeros((count, 2))
        self.finals = copy_records(self.outcomes)
        self.final_observations = np.zeros(self.observations.shape, self.observations.dtype)
        self.listeners = Listeners()
        self.changes = 0
        threads = self._most_threads or thread_count(count, self.config.observation)
        self._shares = [[self._block(index) for index in share] for share in divide(count, threads)]
        self._threads = Threads("arkanoid") if len(self._shares) > 1 else None
        self.alone = OneThread("this environment")
        self._ready = False

    def clone(self) -> "Batch":
        """Return an independent batch in the same state, without listeners."""
        clone = object.__new__(Batch)
        clone.__dict__.update(self.__dict__)
        clone.worlds = copy_records(self.worlds)
        clone.outcomes = copy_records(self.outcomes)
        clone.observer = self.observer.clone()
        clone._prepare()
        return clone

    def __deepcopy__(self, memo: dict[int, Any]) -> "Batch":
        return self.clone()

    def __reduce__(self) -> tuple[Any, ...]:
        # Threads and views into other arrays can't be pickled; they are made anew.
        arguments = (self.num_worlds, self.config, self.autoreset, self._most_threads, self.plan)
        return Batch, arguments, (self.worlds, self.outcomes, self.observations)

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        seeded = state[0]["random"] != 0
        if not (_bytes_of(state[0])[~seeded] == _bytes_of(self.worlds)[~seeded]).all():
            raise ValueError("a world without random numbers can't have played")
        if seeded.any():
            self._check(*(part[seeded] for part in state))
        self.adopt(*state)

    @property
    def num_worlds(self) -> int:
        """The number of worlds."""
        return len(self.worlds)

    @property
    def observations(self) -> NDArray[Any]:
        """The latest observations, [n, ...]."""
        return self.observer.observations

    @property
    def state(self) -> Worlds:
        """The state of the worlds, read-only `World` records [n] that each step changes."""
        # Through memory that is read-only itself: a flag could be set back.
        return np.frombuffer(memoryview(self.worlds.view(np.uint8)).toreadonly(), World)

    @property
    def seeded(self) -> NDArray[np.bool_]:
        """Whether each world's generator was seeded, bool [n]; one that was is never zero."""
        seeded: NDArray[np.bool_] = self.worlds["random"] != 0
        return seeded

    @cached_property
    def setup(self) -> bytes:
        """What a state depends on besides itself, see `snapshots`."""
        return describe_setup(self.config, self.plan, self.rules, self.observations.dtype)

    def _make_ready(self) -> None:
        """Look at worlds that anything but a whole step has changed, before they are stepped.

        Raises:
            ResetNeeded: a world must be reset before.
        """
        over = self.worlds["done"] != 0
        waits = self.worlds["round_number"] == 0
        if self.autoreset is Autoreset.DISABLED:
            waits |= over
        if waits.any():
            raise why_refused(self.worlds)
        self.end_interrupted_step()

    def end_interrupted_step(self) -> None:
        """Begin the episodes that a step in same-step mode should have begun, but for Ctrl-C."""
        over = self.worlds["done"] != 0
        if self.autoreset is Autoreset.SAME_STEP and over.any():
            for block in self._all_blocks():
                block.reset(over[block.where])

    def check_world(self, index: int) -> None:
        """Raise a TypeError for what is no index, a ValueError if it is of no world."""
        check_integer("world", index, 0, self.num_worlds - 1)

    def seed(self, index: int, seed: int) -> None:
        """Seed one world's generator."""
        self.worlds["random"][index] = seed_state(seed)

    def command(self, actions: Any) -> None:
        """Take actions as the worlds' commands: integers [n], or velocities and fire, [n, 2].

        Velocities are rounded to float32, and those beyond -1 and 1 count as -1 and 1.

        Raises:
            TypeError: they are no array.
            ValueError: their number or an integer is illegal, or a velocity is NaN.
        """
        if self._table is None:
            self._command_velocities(read_array(actions, BOX))
            return
        array = read_array(actions, f"Discrete({len(self._table)})")
        if array.shape != (self.num_worlds,) or array.dtype.kind not in "iu":
            raise ValueError(
                f"actions must be {self.num_worlds} integers, one for each world, in "
                f"Discrete({len(self._table)}); got {array.dtype} of shape {array.shape}"
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
                f"each world, in {BOX}; got {array.dtype} of shape {array.shape}"
            )
        wrong = decode_velocities(as_float32(array), self.commands)
        if wrong >= 0:
            raise ValueError(
                f"action {array[wrong].tolist()} of world {wrong} is not in {BOX}: it has a NaN"
            )

    def reset(
        self,
        mask: NDArray[np.bool_],
        options: dict[str, Any] | None = None,
        seeds: Sequence[int | None] | None = None,
    ) -> None:
        """Begin a new episode in some worlds.

        It is a new game, unless a life was just lost (`episodic_life`) and the world gets neither a
        seed nor options.

        Args:
            mask: of these worlds, bool [n].
            options: how this and the following episodes begin, see `starts`.
            seeds: of each world, or None. A world with a seed forgets its earlier options.

        Raises:
            TypeError, ValueError: an option has an illegal value; then nothing changes.
            RuntimeError: another call is in progress.
        """
        start = read_start(options or {}, self.config, self.plan)
        self.alone.run(self._reset, mask, start, seeds)

    def _reset(
        self,
        mask: NDArray[np.bool_],
        start: dict[str, Any],
        seeds: Sequence[int | None] | None,
    ) -> None:
        self._ready = False
        self.changes += 1
        if seeds is not None:
            self._seed_anew(mask, seeds)
        if start:
            set_starts(self.worlds, mask, start)
            self.worlds["done"][mask] = GAME_OVER
        for block in self._all_blocks():
            block.reset(mask[block.where])
            block.observe(mask[block.where])
        for listener in self.listeners:
            listener.reset(mask)
        self._ready = bool(mask.all())

    def _seed_anew(self, mask: NDArray[np.bool_], seeds: Sequence[int | None]) -> None:
        """Seed worlds of a mask; those with a seed will begin a game as if it were their first."""
        seeded = mask & np.array([seed is not None for seed in seeds])
        for index in np.flatnonzero(seeded).tolist():
            self.seed(index, seeds[index])  # type: ignore[arg-type]
        set_starts(self.worlds, seeded, AS_THE_CONFIGURATION_SAYS)
        self.worlds["done"][seeded] = GAME_OVER

    def restore(self, worlds: Any, outcomes: Any, observations: NDArray[Any]) -> None:
        """Go on from another state: records or their bytes, of each world or of one for all.

        Raises:
            ValueError: no play leads to this state, or an episode is over in it, which this mode
                forbids; the message names the field. Nothing changes then.
        """
        aligned = zeros_in_lines((len(worlds),), World), zeros_in_lines((len(worlds),), Outcome)
        for records, found in zip(aligned, (worlds, outcomes), strict=True):
            _bytes_of(records)[:] = _bytes_of(found)
        self._check(*aligned, observations)
        self.adopt(*aligned, observations)

    def _check(self, worlds: Worlds, outcomes: Outcomes, observations: NDArray[Any]) -> None:
        """Raise a ValueError if no play leads to this state, see `restore`."""
        # Imported on demand: most play restores nothing.
        from .validity import check_outcomes, check_worlds

        check_worlds(worlds, self.rules, self.config.episodic_life)
        check_outcomes(outcomes)
        self.observer.check(observations)
        if self.autoreset is Autoreset.SAME_STEP and worlds["done"].any():
            raise ValueError(
                "an episode is over in the snapshot, and with autoreset_mode='SameStep' the next "
                "one would have begun: restore it in an environment of another mode"
            )

    def adopt(self, worlds: Worlds, outcomes: Outcomes, observations: NDArray[Any]) -> None:
        """Take a state that was checked."""
        self._ready = False
        self.changes += 1
        _bytes_of(self.worlds)[:] = _bytes_of(worlds)
        _bytes_of(self.outcomes)[:] = _bytes_of(outcomes)
        self.observer.recall(observations)
        for listener in self.listeners:
            listener.interrupt()

    def step(self) -> None:
        """Play one decision, as `commands` say, in each world, and observe it.

        Raises:
            ResetNeeded: a world was never reset, or without autoreset its episode is over.
            RuntimeError: another call is in progress.
        """
        alone = self.alone
        # As a call, `OneThread.run` would take a good part of the step of a single world.
        if alone.taken:
            alone.refuse()
        alone.taken = True
        try:
            if not self._ready:
                self._make_ready()
            # Until all of it is done: Ctrl-C may come at any time.
            self._ready = False
            self.changes += 1
            self.observer.advance()
            if self._threads is None:
                over = self._step_blocks(self._shares[0])
            else:
                over = sum(self._threads.run(self._step_blocks, self._shares))
            if self.listeners.references:
                for listener in self.listeners:
                    listener.step()
            self._ready = over == 0 or self.autoreset is not Autoreset.DISABLED
        finally:
            alone.taken = False

    def observe(self, mask: NDArray[np.bool_]) -> None:
        """Observe the worlds of a mask, bool [n], as they are."""
        for block in self._all_blocks():
            block.observe(mask[block.where])

    def close(self) -> None:
        """End the threads; a later step starts them again."""
        if self._threads is not None:
            self._threads.close()

    def _step_blocks(self, blocks: list[Block]) -> int:
        """Play one decision in the worlds of some blocks; return how many episodes are over."""
        total = 0
        for block in blocks:
            over = block.play()
            # While the worlds are still in the cache.
            block.observe(block.everywhere)
            if over > 0 and self.autoreset is Autoreset.SAME_STEP:
                self._begin_again(block)
            total += over
        return total

    def _begin_again(self, block: Block) -> None:
        """Begin new episodes where they are over, and keep apart how those ended."""
        outcomes = block.outcomes
        over = block.worlds["done"] != 0
        ended = outcomes[over]
        self.finals[block.where][over] = ended
        self.final_observations[block.where][over] = self.observations[block.where][over]
        block.reset(over)
        block.observe(over)
        for field in ("reward", "terminated", "truncated"):
            outcomes[field][over] = ended[field]

    def _all_blocks(self) -> Iterator[Block]:
        return itertools.chain.from_iterable(self._shares)

    def _block(self, index: slice) -> Block:
        worlds, outcomes = self.worlds[index], self.outcomes[index]
        game = worlds, self.rules, self.levels, outcomes
        next_step = self.autoreset is Autoreset.NEXT_STEP
        return Block(
            where=index,
            worlds=worlds,
            outcomes=outcomes,
            play=partial(
                step_worlds, *game, self.commands[index], next_step, self.config.episodic_life
            ),
            reset=partial(reset_worlds, *game),
            observe=self.observer.part(self.worlds, self.rules, index),
            everywhere=np.ones(len(worlds), np.bool_),
        )
