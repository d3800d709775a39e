"""A batch of worlds and the one way to step it, whether it holds one world or ten thousand."""

import itertools
import os
from concurrent.futures import ThreadPoolExecutor
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..physics.compilation import inlined, kernel
from .config import Config
from .curriculum import choose_starts, forget_starts
from .episode import begin_episode
from .game import clear_events, decide
from .level_plan import plan_levels
from .observation import observe, vector_space
from .random import seed_state
from .rulebook import make_rules
from .state import Outcome, World

# Velocity in [-1, 1] and fire of the discrete actions, float64 [actions, 2].
_MOVES = [[0.0, 0.0], [-1.0, 0.0], [1.0, 0.0]]
_MOVES_WITH_FIRE = [[move, 1.0] for move, _ in _MOVES]

COMMANDS = {
    "discrete3": np.array(_MOVES),
    "discrete6": np.array(_MOVES + _MOVES_WITH_FIRE),
}

# Below this many worlds a thread costs more than it brings.
WORLDS_PER_THREAD = 256


class Autoreset(IntEnum):
    """What a step does with a world whose episode is over."""

    DISABLED = 0
    NEXT_STEP = 1  # the next step resets it, ignoring the action
    SAME_STEP = 2  # the same step resets it, and keeps the last observation and outcome apart


@kernel
def reset_worlds(
    worlds: Any, rules: Any, levels: Any, mask: Any, outcomes: Any, observations: Any
) -> None:
    """Begin a new episode in the worlds of a mask (bool [n]), and observe them."""
    for index in range(worlds.shape[0]):
        if mask[index]:
            _reset_world(worlds, rules, levels, outcomes, observations, index)


@kernel
def _reset_world(
    worlds: Any, rules: Any, levels: Any, outcomes: Any, observations: Any, index: int
) -> None:
    """Begin a new episode in one world."""
    outcome = outcomes[index]
    begin_episode(worlds[index], rules[0], levels)
    clear_events(worlds[index])
    outcome.reward = 0.0
    outcome.hits = 0
    outcome.terminated = False
    outcome.truncated = False
    outcome.truncation = 0
    _report(worlds[index], outcome)
    observe(worlds[index], rules[0], observations[index])


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
    worlds: Any,
    rules: Any,
    levels: Any,
    commands: Any,
    outcomes: Any,
    observations: Any,
    finals: Any,
    final_observations: Any,
    autoreset: int,
) -> None:
    """Play one decision in each world; the outcomes and observations are written in place.

    Args:
        commands: float64 [n, 2], the velocity in [-1, 1] and fire (0 or 1).
        finals, final_observations: in same-step mode, those of the episodes that ended.
        autoreset: an `Autoreset` mode.
    """
    for index in range(worlds.shape[0]):
        world = worlds[index]
        if autoreset == 1 and world.done:
            _reset_world(worlds, rules, levels, outcomes, observations, index)
            continue
        outcome = outcomes[index]
        decide(world, rules[0], levels, commands[index, 0], commands[index, 1], outcome)
        _report(world, outcome)
        observe(world, rules[0], observations[index])
        if autoreset == 2 and world.done:
            reward = outcome.reward
            terminated, truncated = outcome.terminated, outcome.truncated
            finals[index] = outcome
            # As a loop, because assigning a slice costs two seconds of compilation.
            for place in range(observations.shape[1]):
                final_observations[index, place] = observations[index, place]
            _reset_world(worlds, rules, levels, outcomes, observations, index)
            outcome.reward = reward
            outcome.terminated = terminated
            outcome.truncated = truncated


@kernel
def decode_actions(actions: Any, table: Any, commands: Any) -> int:
    """Write what discrete actions (int64 [n]) command; return the first illegal one's world or -1.

    Args:
        table: float64 [actions, 2]; commands: float64 [n, 2].
    """
    for index in range(actions.shape[0]):
        action = actions[index]
        if action < 0 or action >= table.shape[0]:
            return index
        commands[index, 0] = table[action, 0]
        commands[index, 1] = table[action, 1]
    return -1


@kernel
def decode_velocities(actions: Any, commands: Any) -> int:
    """Write what box actions (float64 [n, 2]) command; return the first illegal one's world or -1.

    Args:
        commands: float64 [n, 2].
    """
    for index in range(actions.shape[0]):
        move, fire = actions[index, 0], actions[index, 1]
        # In this order a NaN is illegal.
        if not (-1.0 <= move <= 1.0 and -1.0 <= fire <= 1.0):
            return index
        commands[index, 0] = move
        commands[index, 1] = 1.0 if fire > 0.0 else 0.0
    return -1


class Batch:
    """Worlds that are played together, with the arrays that their steps read and write.

    Args:
        num_worlds: how many, at least 1.
        config: the rules they share.
        threads: how many threads step them at the most; None lets the batch's size decide.

    Attributes:
        worlds: the state, `World` records [n].
        plan: the levels; rules: `Rules` [1]; levels: `Level` records.
        commands: float64 [n, 2], to be filled before `step`.
        outcomes, finals: `Outcome` records [n].
        observations, final_observations: float32 [n, k].
    """

    def __init__(
        self,
        num_worlds: int,
        config: Config,
        autoreset: Autoreset = Autoreset.DISABLED,
        threads: int | None = None,
    ) -> None:
        self.config = config
        self.autoreset = autoreset
        self.plan = plan_levels(config)
        self.rules = make_rules(config, self.plan)
        self.levels = self.plan.table
        self.worlds = np.zeros(num_worlds, World)
        forget_starts(self.worlds)
        self.commands: NDArray[np.float64] = np.zeros((num_worlds, 2))
        self.outcomes = np.zeros(num_worlds, Outcome)
        self.finals = np.zeros(num_worlds, Outcome)
        (length,) = vector_space(config).shape or ()
        self.observations: NDArray[np.float32] = np.zeros((num_worlds, length), np.float32)
        self.final_observations = np.zeros_like(self.observations)
        self._table = COMMANDS.get(config.actions)
        self._chunks = self._split(threads)
        self._pool: ThreadPoolExecutor | None = None

    @property
    def num_worlds(self) -> int:
        """The number of worlds."""
        return len(self.worlds)

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
        reset_worlds(self.worlds, self.rules, self.levels, mask, self.outcomes, self.observations)

    def restore(self, worlds: Any) -> None:
        """Go on from a snapshot, a copy of `worlds`; the observations follow with the next step."""
        self.worlds[:] = worlds
        # What is written only when it changes must be written anew.
        self.worlds["lattice_changed"] = 1
        self.worlds["capsules_shown"] = 1
        self.worlds["enemies_shown"] = 1

    def step(self) -> None:
        """Play one decision, as `commands` say, in each world."""
        if len(self._chunks) == 1:
            step_worlds(*self._chunks[0])
            return
        if self._pool is None:
            self._pool = ThreadPoolExecutor(len(self._chunks) - 1, "arkanoid")
        # The kernels release the GIL; the calling thread takes a share, too.
        running = [self._pool.submit(step_worlds, *chunk) for chunk in self._chunks[1:]]
        step_worlds(*self._chunks[0])
        for task in running:
            task.result()

    def close(self) -> None:
        """End the threads; a later step starts them again."""
        if self._pool is not None:
            self._pool.shutdown()
            self._pool = None

    def _split(self, threads: int | None) -> list[tuple[Any, ...]]:
        """Return the kernel's arguments for each thread's share of the worlds."""
        if threads is None:
            threads = min(os.cpu_count() or 1, max(1, self.num_worlds // WORLDS_PER_THREAD))
        bounds = np.linspace(0, self.num_worlds, min(threads, self.num_worlds) + 1).astype(int)
        return [
            (
                self.worlds[start:stop],
                self.rules,
                self.levels,
                self.commands[start:stop],
                self.outcomes[start:stop],
                self.observations[start:stop],
                self.finals[start:stop],
                self.final_observations[start:stop],
                int(self.autoreset),
            )
            for start, stop in itertools.pairwise(bounds)
        ]
