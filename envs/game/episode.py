"""How an episode, a round and a life begin."""

from ...physics.kernels import inlined, inner
from ..levels.generator import lay_level
from ..rules import (
    BOSS_HITS,
    CELLS,
    DIFFICULTY_STEP,
    EXTRA_LIFE_FIRST,
    FIELD_WIDTH,
    NO_POWER,
)
from ..state import (
    AS_CONFIGURED,
    GIVEN_LAYOUT,
    GIVEN_SEED,
    REPEATED_SEED,
    Levels,
    RulesRecord,
    WorldRecord,
)
from .beams import remove_beams
from .boss import remove_shards
from .bricks import lay_bricks
from .capsules import remove_capsule
from .enemies import remove_enemies
from .powers import set_power
from .random import uniform
from .serve import lay_ball


@inlined
def begin_episode(world: WorldRecord, rules: RulesRecord, levels: Levels) -> None:
    """Start a new game. The world keeps its random generator, and how its episodes begin."""
    world.first_random = world.random
    world.done = 0
    world.decisions = 0
    world.score = 0
    world.lives = rules.lives
    world.next_life = EXTRA_LIFE_FIRST
    world.round_number = max(1, world.start_round)
    world.capped = 0
    world.paddle_x = FIELD_WIDTH / 2
    world.paddle_vx = 0.0
    world.move = 0.0
    world.fire = 0.0
    world.exit_open = 0
    set_power(world, rules, NO_POWER)
    if world.start == AS_CONFIGURED:
        begin_round(world, rules, levels)
        return
    if world.start == GIVEN_SEED or world.start == REPEATED_SEED:
        lay_level(world.kind, world.start_seed, _difficulty(world, rules, 0))
    elif world.start == GIVEN_LAYOUT:
        for cell in range(CELLS):
            world.kind[cell] = world.start_kind[cell]
    _lay_round(world, rules, world.start_boss)


@inner
def begin_round(world: WorldRecord, rules: RulesRecord, levels: Levels) -> None:
    """Begin the round of the world's number: a level of the table, or a generated one."""
    index = world.round_number - 1
    named = levels.shape[0] if rules.table_counts == 1 else 0
    boss = 0
    if world.start == REPEATED_SEED:
        lay_level(world.kind, world.start_seed, _difficulty(world, rules, index))
    elif named > 0 and (index < named or rules.endless == 0):
        index %= named
        boss = int(levels[index].boss)
        for cell in range(CELLS):
            world.kind[cell] = levels[index].kind[cell]
    else:
        seed = rules.first_seed + int(uniform(world) * rules.num_seeds)
        lay_level(world.kind, seed, _difficulty(world, rules, index - named))
    _lay_round(world, rules, boss)


@inner
def _difficulty(world: WorldRecord, rules: RulesRecord, generated: int) -> float:
    """Return the difficulty of a generated round.

    Args:
        generated: how many generated rounds came before it.
    """
    if world.start_difficulty >= 0.0:
        return float(world.start_difficulty)
    if rules.difficulty >= 0.0:
        return float(rules.difficulty)
    return float(min(1.0, rules.first_difficulty + DIFFICULTY_STEP * generated))


@inner
def _lay_round(world: WorldRecord, rules: RulesRecord, boss: int) -> None:
    """Lay the bricks of the world's layout, and the ball."""
    world.cleared = 0
    world.boss_hits = BOSS_HITS if boss == 1 else 0
    lay_bricks(world)
    world.needed += world.boss_hits
    world.hits_left = world.needed
    _begin_serve(world, rules)


@inner
def _begin_serve(world: WorldRecord, rules: RulesRecord) -> None:
    """Lay a ball on the paddle, remove everything that flies, and start the idle clock."""
    lay_ball(world)
    world.idle = 0
    world.exit_open = 0
    remove_capsule(world)
    remove_beams(world)
    remove_shards(world)
    if rules.enemies == 1:
        remove_enemies(world)


@inner
def lose_life(world: WorldRecord, rules: RulesRecord) -> None:
    """Take a life and the power; with another life the round goes on with the bricks left."""
    world.lives -= 1
    world.lives_lost += 1
    if world.lives > 0:
        set_power(world, rules, NO_POWER)
        _begin_serve(world, rules)
