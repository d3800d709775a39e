"""The kernels that reset and step the worlds of a batch."""

from typing import Any

from ...physics.kernels import inlined, kernel
from ...physics.kernels.prefetch import prefetch
from ..game.episode import begin_episode
from ..game.tick import clear_events, play_decision
from ..state import (
    LIFE_LOST,
    Levels,
    Outcome,
    OutcomeRecord,
    Outcomes,
    RulesRecord,
    SharedRules,
    World,
    WorldRecord,
    Worlds,
)

# How many worlds ahead memory is asked for: a decision takes about as long as it takes to come.
_AHEAD = 2
# The bytes of a world that a step touches, whatever happens.
_EVERY_STEP = World.fields["enemy_x"][1]  # type: ignore[index]
_OUTCOME = Outcome.itemsize


@kernel
def reset_worlds(
    worlds: Worlds, rules: SharedRules, levels: Levels, outcomes: Outcomes, mask: Any
) -> None:
    """Begin a new episode in the worlds of a mask, bool [n]."""
    for index in range(worlds.shape[0]):
        if mask[index]:
            _reset_world(worlds[index], rules[0], levels, outcomes[index])


@kernel
def _reset_world(
    world: WorldRecord, rules: RulesRecord, levels: Levels, outcome: OutcomeRecord
) -> None:
    """Begin a new episode in one world: a new game, or the next life of the present one."""
    if world.done == LIFE_LOST:
        world.done = 0
    else:
        begin_episode(world, rules, levels)
    world.first_decision = world.decisions
    clear_events(world)
    outcome.reward = 0.0
    outcome.hits = 0
    outcome.terminated = False
    outcome.truncated = False
    outcome.truncation = 0
    _report(world, outcome)


@inlined
def _report(world: WorldRecord, outcome: OutcomeRecord) -> None:
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
def tabulate_outcomes(outcomes: Outcomes, table: Any) -> None:
    """Write what `info` shows, int64 [fields, n], in the order of `INFO_FIELDS`."""
    for index in range(outcomes.shape[0]):
        outcome = outcomes[index]
        table[0, index] = outcome.score
        table[1, index] = outcome.lives
        table[2, index] = outcome.round_number
        table[3, index] = outcome.bricks_left
        table[4, index] = outcome.truncation
        table[5, index] = outcome.hits
        table[6, index] = outcome.bricks_broken
        table[7, index] = outcome.capsules_caught
        table[8, index] = outcome.enemies_destroyed
        table[9, index] = outcome.lives_lost
        table[10, index] = outcome.lives_gained
        table[11, index] = outcome.rounds_cleared


@kernel
def step_worlds(
    worlds: Worlds,
    rules: SharedRules,
    levels: Levels,
    outcomes: Outcomes,
    commands: Any,
    next_step: bool,
    episodic_life: bool,
) -> int:
    """Play one decision in each world; return how many episodes are over.

    Args:
        outcomes: written in place.
        commands: float64 [n, 2], the velocity in [-1, 1] and fire (0 or 1).
        next_step: whether a world whose episode was over before begins a new one instead.
        episodic_life: whether a lost life ends an episode. It changes nothing in the game.
    """
    over = 0
    for index in range(worlds.shape[0]):
        if index + _AHEAD < worlds.shape[0]:
            prefetch(worlds, index + _AHEAD, 0, _EVERY_STEP)
            prefetch(outcomes, index + _AHEAD, 0, _OUTCOME)
        world, outcome = worlds[index], outcomes[index]
        if next_step and world.done:
            _reset_world(world, rules[0], levels, outcome)
            continue
        play_decision(world, rules[0], levels, commands[index, 0], commands[index, 1], outcome)
        _report(world, outcome)
        if episodic_life and world.lives_lost > 0:
            outcome.terminated = True
            if world.done == 0:
                world.done = LIFE_LOST
        over += world.done != 0
    return over
