"""Which discrete actions do something, for algorithms that mask the others (`MaskablePPO`)."""

import numpy as np
from numpy.typing import NDArray

from ..physics.kernels import inlined, inner, kernel
from ..physics.pairs.lattice import cell_centre
from .actions import COMMANDS
from .config import Config
from .interface import check_was_reset
from .rules import (
    BALL_RADIUS,
    BEAM_HEIGHT,
    BEAM_SPEED,
    BEAM_WIDTH,
    BOSS_X,
    BOSS_Y,
    BRICK_HEIGHT,
    BRICK_WIDTH,
    CAPSULE_HEIGHT,
    CAPSULE_SPEED,
    CATCH,
    CELLS,
    ENLARGE,
    FIELD_WIDTH,
    LASER,
    MAX_BALLS,
    MAX_BEAMS,
    MAX_SHARDS,
    NO_CAPSULE,
    PADDLE_TOP,
    SHARD_SPEED,
    SPEED_STAGE_MAX,
    UNBREAKABLE,
)
from .state import ABSENT, HELD, RulesRecord, SharedRules, WorldRecord, Worlds

LEFT, RIGHT, FIRE = 0, 1, 2

# In longer decisions anything may happen. In shorter ones no capsule or shard that is not there yet
# reaches the paddle.
_FORESEEN = 16  # ticks
# The paddle may push a ball in its way by its own thickness: all reaches are longer by this.
_PUSH = 1.0
_BOSS_SIZE = 2.5  # no part of the boss is further from its middle, across or up


def action_masks(config: Config, worlds: Worlds, rules: SharedRules) -> NDArray[np.bool_]:
    """Return which actions do something in each world, bool [n, actions]; no-op always does.

    What is masked does nothing in the coming decision: without it the game takes the same course,
    bit for bit. Moving to a wall that the paddle touches does nothing, unless a gate is open there
    or the paddle may become shorter. Fire does nothing where no ball lies on the paddle and no
    laser can shoot, unless that may change within the decision. Where one part of an action does
    nothing, the action is masked: the same without that part is not.

    With `sticky_action`, the decision after it may still repeat a masked action.

    Args:
        config: of the worlds.
        worlds: their states.
        rules: theirs.

    Raises:
        ValueError: the actions are continuous.
        ResetNeeded: a world was never reset.
    """
    table = COMMANDS.get(config.actions)
    if table is None:
        raise ValueError(
            f"actions={config.actions!r} are continuous and have no masks: use 'discrete6'"
        )
    check_was_reset(worlds, "action_masks()")
    useful = np.empty((len(worlds), 3), np.bool_)
    find_useful(worlds, rules, useful)
    masks = np.ones((len(worlds), len(table)), np.bool_)
    masks[:, table[:, 0] < 0.0] &= useful[:, [LEFT]]
    masks[:, table[:, 0] > 0.0] &= useful[:, [RIGHT]]
    masks[:, table[:, 1] > 0.0] &= useful[:, [FIRE]]
    return masks


@kernel
def find_useful(worlds: Worlds, rules: SharedRules, useful: NDArray[np.bool_]) -> None:
    """Write whether left, right and fire may do something in each world, bool [n, 3]."""
    for index in range(worlds.shape[0]):
        world = worlds[index]
        # What happens in the last tick comes too late for a command.
        ticks = rules[0].frame_skip - 1
        caught, lost = _may_catch_capsule(world, ticks), _may_lose_life(world, rules[0], ticks)
        long = world.power == ENLARGE or world.capsule != NO_CAPSULE
        shrinks = long and (caught or lost)
        x, half = world.paddle_x, world.paddle_half
        useful[index, LEFT] = shrinks or x > half
        useful[index, RIGHT] = shrinks or x < FIELD_WIDTH - half or world.exit_open == 1
        useful[index, FIRE] = (
            caught
            or lost
            or _may_release(world, rules[0], ticks)
            or _may_shoot(world, ticks + 1)
            or _may_clear_round(world, rules[0], ticks)
        )


@inlined
def _reach(rules: RulesRecord, ticks: int) -> float:
    """Return how far a ball comes at most in some ticks."""
    return float(ticks * rules.ball_speed * (1.0 + 0.25 * SPEED_STAGE_MAX) + _PUSH)


@inner
def _may_catch_capsule(world: WorldRecord, ticks: int) -> bool:
    """Tell whether the paddle may catch a capsule within some ticks."""
    if ticks > _FORESEEN:
        return True
    lowest = world.capsule_y - ticks * CAPSULE_SPEED
    return bool(ticks > 0 and world.capsule != NO_CAPSULE and lowest <= PADDLE_TOP + CAPSULE_HEIGHT)


@inner
def _may_lose_life(world: WorldRecord, rules: RulesRecord, ticks: int) -> bool:
    """Tell whether the last ball may fall out, or a shard land, within some ticks."""
    if ticks > _FORESEEN:
        return True
    if ticks <= 0:
        return False
    highest = 0.0
    for ball in range(MAX_BALLS):
        if world.ball_state[ball] != ABSENT:
            highest = max(highest, world.ball_y[ball])
    if highest <= _reach(rules, ticks):
        return True
    for shard in range(MAX_SHARDS):
        lowest = world.shard_y[shard] - ticks * SHARD_SPEED
        if world.shard_state[shard] != ABSENT and lowest <= PADDLE_TOP + 1.0:
            return True
    return False


@inner
def _may_release(world: WorldRecord, rules: RulesRecord, ticks: int) -> bool:
    """Tell whether a ball lies on the paddle, or may be caught by it within some ticks."""
    catches = world.power == CATCH and ticks > 0
    height = PADDLE_TOP + _reach(rules, ticks)
    for ball in range(MAX_BALLS):
        state = world.ball_state[ball]
        if state == HELD or (catches and state != ABSENT and world.ball_y[ball] <= height):
            return True
    return False


@inlined
def _may_shoot(world: WorldRecord, ticks: int) -> bool:
    """Tell whether the laser that the player has will be ready within some ticks."""
    return bool(world.power == LASER and world.beam_wait <= ticks)


@inner
def _may_clear_round(world: WorldRecord, rules: RulesRecord, ticks: int) -> bool:
    """Tell whether the round may be cleared within some ticks."""
    if ticks > _FORESEEN:
        return True
    if ticks <= 0:
        return False
    further = world.paddle_x + ticks * rules.paddle_speed
    if world.exit_open == 1 and further >= FIELD_WIDTH - world.paddle_half - _PUSH:
        return True
    if world.boss_hits > 0 and not _in_reach(
        world, rules, ticks, BOSS_X, BOSS_Y, _BOSS_SIZE, _BOSS_SIZE
    ):
        return False
    # The first brick out of reach is enough: this is seldom a long search.
    for cell in range(CELLS):
        if 0 < world.brick_hits[cell] < UNBREAKABLE:
            x, y = cell_centre(rules.lattice[0], cell)
            if not _in_reach(world, rules, ticks, x, y, 0.5 * BRICK_WIDTH, 0.5 * BRICK_HEIGHT):
                return False
    return True


@inner
def _in_reach(
    world: WorldRecord,
    rules: RulesRecord,
    ticks: int,
    x: float,
    y: float,
    half_width: float,
    half_height: float,
) -> bool:
    """Tell whether a ball or a beam may hit a box at (x, y) within some ticks."""
    reach = _reach(rules, ticks) + BALL_RADIUS
    for ball in range(MAX_BALLS):
        if (
            world.ball_state[ball] != ABSENT
            and abs(world.ball_x[ball] - x) <= reach + half_width
            and abs(world.ball_y[ball] - y) <= reach + half_height
        ):
            return True
    for beam in range(MAX_BEAMS):
        if (
            world.beam_state[beam] != ABSENT
            and abs(world.beam_x[beam] - x) <= BEAM_WIDTH + half_width
            and -BEAM_HEIGHT - half_height
            <= y - world.beam_y[beam]
            <= ticks * BEAM_SPEED + BEAM_HEIGHT + half_height
        ):
            return True
    return False
