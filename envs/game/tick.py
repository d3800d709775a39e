"""The game: a decision, and a tick as a list of phases."""

from ...physics.kernels import inlined, kernel
from ..rules import (
    IDLE_TICKS,
    MAX_BALLS,
    NO_CAPSULE,
    PROGRESS,
    SCORE,
)
from ..state import (
    DECISION_LIMIT,
    FLYING,
    MOST_ROUNDS,
    NOT_TRUNCATED,
    Levels,
    OutcomeRecord,
    RulesRecord,
    WorldRecord,
)
from .beams import fly_beams, shoot
from .boss import fly_shards, throw_shards
from .capsules import fall_capsule
from .enemies import move_enemies, open_gates, steer_enemies
from .episode import begin_round, lose_life
from .flight import fly_balls, free_balls
from .paddle import leave_by_exit, move_paddle, steer_paddle
from .random import uniform
from .serve import balls_in_play, carry_balls, release_balls, remove_ball


@inlined
def play_decision(
    world: WorldRecord,
    rules: RulesRecord,
    levels: Levels,
    move: float,
    fire: float,
    outcome: OutcomeRecord,
) -> None:
    """Play one decision, `frame_skip` ticks or fewer if the episode ends; write its outcome.

    Args:
        move: velocity command in [-1, 1], as a part of the paddle's speed; fire: 1.0 or 0.0.
    """
    if rules.sticky_action > 0.0 and uniform(world) < rules.sticky_action:
        move, fire = world.move, world.fire
    world.move = move
    world.fire = fire
    clear_events(world)
    outcome.reward = 0.0
    outcome.hits = 0
    outcome.terminated = False
    outcome.truncation = NOT_TRUNCATED
    for _ in range(rules.frame_skip):
        _reward_tick(world, rules, levels, outcome)
        if outcome.terminated:
            break
    world.decisions += 1
    if world.decisions >= rules.max_decisions:
        outcome.truncation = DECISION_LIMIT
    outcome.truncated = outcome.truncation != NOT_TRUNCATED
    world.done = 1 if outcome.terminated or outcome.truncated else 0


@kernel
def clear_events(world: WorldRecord) -> None:
    """Forget what happened in the previous decision."""
    world.bricks_broken = 0
    world.capsules_caught = 0
    world.enemies_destroyed = 0
    world.lives_lost = 0
    world.lives_gained = 0
    world.rounds_cleared = 0


@inlined
def _reward_tick(
    world: WorldRecord, rules: RulesRecord, levels: Levels, outcome: OutcomeRecord
) -> None:
    """Play one tick, and add its reward to the outcome."""
    score, lost, hits = world.score, world.lives_lost, world.hits_left
    _tick(world, rules)
    hits -= world.hits_left
    outcome.hits += hits
    if rules.reward == PROGRESS:
        outcome.reward += hits / world.needed + world.cleared
    elif rules.reward == SCORE:
        outcome.reward += (world.score - score) / 1000.0
    else:
        outcome.reward += world.cleared
    outcome.reward -= rules.life_penalty * (world.lives_lost - lost)
    if world.lives == 0:
        outcome.terminated = True
    if world.cleared == 1:
        world.rounds_cleared += 1
        world.round_number = min(world.round_number + 1, MOST_ROUNDS)
        begin_round(world, rules, levels)


@inlined
def _tick(world: WorldRecord, rules: RulesRecord) -> None:
    """Play one tick of 1/60 s; it ends early when the round is cleared."""
    world.idle += 1
    steer_paddle(world, rules)
    if world.exit_open == 1:
        leave_by_exit(world, rules)
    release_balls(world, rules)
    shoot(world, rules)
    _act_enemies(world, rules)
    fly_balls(world, rules)
    if world.beams > 0:
        fly_beams(world, rules)
    if world.cleared == 1:
        return
    if world.capsule != NO_CAPSULE:
        fall_capsule(world, rules)
    if world.enemies > 0:
        move_enemies(world, rules)
    landed = world.shards > 0 and fly_shards(world, rules)
    move_paddle(world)
    free_balls(world, rules)
    carry_balls(world)
    if _lose_balls(world) or landed or world.idle >= IDLE_TICKS:
        lose_life(world, rules)


@inlined
def _act_enemies(world: WorldRecord, rules: RulesRecord) -> None:
    """Let enemies come in and choose their ways; in a round with the boss, let the boss act."""
    if world.boss_hits > 0:
        throw_shards(world)
    elif rules.enemies == 1:
        open_gates(world)
        if world.enemies > 0:
            steer_enemies(world, rules)


@inlined
def _lose_balls(world: WorldRecord) -> bool:
    """Remove the balls below the field; return whether the last one is lost."""
    lost = 0
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] == FLYING and world.ball_y[ball] < 0.0:
            remove_ball(world, ball)
            lost += 1
    return bool(lost > 0 and balls_in_play(world) == 0)
