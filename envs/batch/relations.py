"""How the fields of a world depend on each other and on the rules, for states from outside."""

import math

from ...physics.kernels import inner, kernel
from ..game.bricks import hits_needed
from ..game.shapes import LONG_PADDLE_SHAPE, PADDLE_SHAPE
from ..ranges import ROUNDING
from ..rules import (
    BALL_RADIUS,
    CELLS,
    EMPTY,
    ENLARGE,
    EXTRA_LIFE_EVERY,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    GOLD,
    IDLE_TICKS,
    MAX_BALLS,
    MAX_BEAMS,
    MAX_ENEMIES,
    MAX_SHARDS,
    NO_CAPSULE,
    NO_POWER,
    PADDLE_Y,
    SHARD_SPEED,
    SPEED_STAGE_MAX,
    SPEED_STAGE_MIN,
    UNBREAKABLE,
)
from ..state import (
    ABSENT,
    CIRCLING,
    FLYING,
    GAME_OVER,
    GIVEN_LAYOUT,
    HELD,
    RulesRecord,
    SharedRules,
    WorldRecord,
    Worlds,
)

# The fields that a fault may be in. Kernels return their places here, for they have no words.
RELATED = (
    "",  # no fault
    *("decisions", "first_decision", "lives", "done", "next_life", "idle"),
    *("paddle_half", "paddle_x", "paddle_vx", "fire", "power"),
    *("ball_state", "ball_x", "ball_y", "ball_vx", "ball_offset"),
    *("brick_hits", "bricks_left", "hits_left", "needed"),
    *("beam_state", "beams", "shard_state", "shard_vx", "shards"),
    *("enemy_side", "enemy_course_x", "enemy_x", "enemies", "boss_hits", "enemy_wait"),
    *("start_difficulty", "start_boss", "start_kind"),
)
_DECISIONS, _FIRST_DECISION, _LIVES, _DONE, _NEXT_LIFE, _IDLE = range(1, 7)
_PADDLE_HALF, _PADDLE_X, _PADDLE_VX, _FIRE, _POWER = range(7, 12)
_BALL_STATE, _BALL_X, _BALL_Y, _BALL_VX, _BALL_OFFSET = range(12, 17)
_BRICK_HITS, _BRICKS_LEFT, _HITS_LEFT, _NEEDED = range(17, 21)
_BEAM_STATE, _BEAMS, _SHARD_STATE, _SHARD_VX, _SHARDS = range(21, 26)
_ENEMY_SIDE, _ENEMY_COURSE, _ENEMY_X, _ENEMIES, _BOSS_HITS, _ENEMY_WAIT = range(26, 32)
_START_DIFFICULTY, _START_BOSS, _START_KIND = range(32, 35)

# An enemy nearer to the paddle's middle than this has no way to it.
_TOO_NEAR = 1e-6


@kernel
def find_fault(worlds: Worlds, rules: SharedRules, episodic_life: bool) -> int:
    """Return world * len(RELATED) + field of the first fault among worlds; 0 if there is none."""
    for index in range(worlds.shape[0]):
        world = worlds[index]
        fault = _check_course(world, rules[0], episodic_life)
        if fault == 0:
            fault = _check_paddle(world, rules[0])
        if fault == 0:
            fault = _check_balls(world, rules[0])
        if fault == 0:
            fault = _check_bricks(world)
        if fault == 0:
            fault = _check_beams_and_shards(world)
        if fault == 0:
            fault = _check_enemies(world, rules[0])
        if fault == 0:
            fault = _check_start(world, rules[0])
        if fault != 0:
            return index * len(RELATED) + fault
    return 0


@inner
def _check_course(world: WorldRecord, rules: RulesRecord, episodic_life: bool) -> int:
    """Check the clocks, lives and points; return the field that is wrong, or 0."""
    over = world.done == GAME_OVER
    last = rules.max_decisions if over else rules.max_decisions - 1
    if world.decisions > last:
        return _DECISIONS
    if world.first_decision > world.decisions:
        return _FIRST_DECISION
    if world.lives == 0 and not over:
        return _LIVES
    # So long an idleness costs a life, and the clock starts anew unless it was the last one.
    if world.idle >= IDLE_TICKS and world.lives > 0:
        return _IDLE
    if world.done > GAME_OVER and not episodic_life:
        return _DONE
    # The next extra life is ahead, and not further than the rules have it.
    if not world.score < world.next_life <= world.score + EXTRA_LIFE_EVERY:
        return _NEXT_LIFE
    return 0


@inner
def _check_paddle(world: WorldRecord, rules: RulesRecord) -> int:
    """Check the paddle, and what it holds; return the field that is wrong, or 0."""
    half, shape = rules.paddle_half, PADDLE_SHAPE
    if world.power == ENLARGE:
        half, shape = rules.long_paddle_half, LONG_PADDLE_SHAPE
    if world.paddle_half != half or world.paddle_shape != shape:
        return _PADDLE_HALF
    # A paddle wider than the field is where its left end is at the wall.
    furthest = max(half, FIELD_WIDTH - half)
    if not half - ROUNDING <= world.paddle_x <= furthest + ROUNDING:
        return _PADDLE_X
    if abs(world.paddle_vx) > rules.paddle_speed * (1.0 + ROUNDING):
        return _PADDLE_VX
    if world.fire not in (0.0, 1.0):
        return _FIRE
    if rules.capsule_rate == 0.0 and (
        world.power != NO_POWER or world.capsule != NO_CAPSULE or world.exit_open != 0
    ):
        return _POWER
    return 0


@inner
def _check_balls(world: WorldRecord, rules: RulesRecord) -> int:
    """Check the balls; return the field that is wrong, or 0."""
    slowest = rules.ball_speed * (1.0 + 0.25 * SPEED_STAGE_MIN) * (1.0 - ROUNDING)
    fastest = rules.ball_speed * (1.0 + 0.25 * SPEED_STAGE_MAX) * (1.0 + ROUNDING)
    in_play = 0
    for ball in range(MAX_BALLS):
        vx, vy = world.ball_vx[ball], world.ball_vy[ball]
        speed = math.sqrt(vx * vx + vy * vy)
        state = world.ball_state[ball]
        if speed > fastest or (state == FLYING and speed < slowest):
            return _BALL_VX
        if state == ABSENT:
            continue
        in_play += 1
        x, y = world.ball_x[ball], world.ball_y[ball]
        if not BALL_RADIUS - ROUNDING <= x <= FIELD_WIDTH - BALL_RADIUS + ROUNDING:
            return _BALL_X
        if y > FIELD_HEIGHT - BALL_RADIUS + ROUNDING:
            return _BALL_Y
        furthest = max(0.0, world.paddle_half - BALL_RADIUS) + ROUNDING
        if state == HELD and abs(world.ball_offset[ball]) > furthest:
            return _BALL_OFFSET
    if in_play == 0 and world.done != GAME_OVER:
        return _BALL_STATE
    return 0


@inner
def _check_bricks(world: WorldRecord) -> int:
    """Check the bricks against the round's layout; return the field that is wrong, or 0."""
    needed, hits_left, bricks_left = 0, 0, 0
    for cell in range(CELLS):
        hits = int(world.brick_hits[cell])
        whole = hits_needed(world.kind[cell], world.round_number)
        if hits > whole or (whole == UNBREAKABLE and hits != UNBREAKABLE):
            return _BRICK_HITS
        if whole != UNBREAKABLE:
            needed += whole
            hits_left += hits
            bricks_left += hits > 0
    if world.bricks_left != bricks_left:
        return _BRICKS_LEFT
    if world.hits_left != hits_left + world.boss_hits or (
        world.hits_left == 0 and world.done != GAME_OVER
    ):
        return _HITS_LEFT
    if world.needed < max(needed, world.hits_left):
        return _NEEDED
    return 0


@inner
def _check_beams_and_shards(world: WorldRecord) -> int:
    """Check the beams and the shards; return the field that is wrong, or 0."""
    beams = 0
    for beam in range(MAX_BEAMS):
        state = world.beam_state[beam]
        if state not in (ABSENT, FLYING):
            return _BEAM_STATE
        beams += state == FLYING
    if world.beams != beams:
        return _BEAMS
    shards = 0
    for shard in range(MAX_SHARDS):
        state = world.shard_state[shard]
        if state not in (ABSENT, FLYING):
            return _SHARD_STATE
        if state == FLYING:
            shards += 1
            vx, vy = world.shard_vx[shard], world.shard_vy[shard]
            speed = math.sqrt(vx * vx + vy * vy)
            # One that flew up would never leave the game.
            if vy >= 0.0 or abs(speed - SHARD_SPEED) > ROUNDING:
                return _SHARD_VX
    if world.shards != shards or (shards > 0 and world.boss_hits == 0):
        return _SHARDS
    return 0


@inner
def _check_enemies(world: WorldRecord, rules: RulesRecord) -> int:
    """Check the enemies and the boss; return the field that is wrong, or 0."""
    enemies = 0
    for enemy in range(MAX_ENEMIES):
        state = world.enemy_state[enemy]
        if state == ABSENT:
            continue
        enemies += 1
        if abs(world.enemy_side[enemy]) != 1.0:
            return _ENEMY_SIDE
        x, y = world.enemy_course_x[enemy], world.enemy_course_y[enemy]
        if state >= CIRCLING and abs(math.sqrt(x * x + y * y) - 1.0) > ROUNDING:
            return _ENEMY_COURSE
        x, y = world.enemy_x[enemy] - world.paddle_x, world.enemy_y[enemy] - PADDLE_Y
        if abs(x) + abs(y) < _TOO_NEAR:
            return _ENEMY_X
    if world.enemies != enemies:
        return _ENEMIES
    # Where the boss is, enemies would move on without being steered.
    if enemies > 0 and (rules.enemies == 0 or world.boss_hits > 0):
        return _ENEMIES
    if world.boss_hits > 0 and rules.enemies == 0:
        return _BOSS_HITS
    if rules.enemies == 1 and world.enemy_wait == 0:
        return _ENEMY_WAIT
    return 0


@inner
def _check_start(world: WorldRecord, rules: RulesRecord) -> int:
    """Check how the next episode begins; return the field that is wrong, or 0."""
    if world.start_difficulty < 0.0 and world.start_difficulty != -1.0:
        return _START_DIFFICULTY
    if world.start_boss == 1 and rules.enemies == 0:
        return _START_BOSS
    if world.start == GIVEN_LAYOUT and world.start_boss == 0:
        for cell in range(CELLS):
            if EMPTY < world.start_kind[cell] < GOLD:
                return 0
        return _START_KIND
    return 0
