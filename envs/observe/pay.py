"""What `reward="score"` pays, for the observations of games with this reward.

Other games do not show it: with `progress` and `sparse` all bricks pay the same.
"""

from ...physics.kernels import inlined, inner
from ..config import Config
from ..rules import (
    COLOUR_POINTS,
    EMPTY,
    EXTRA_LIFE_EVERY,
    SCORE,
    SILVER,
    SILVER_POINTS,
    UNBREAKABLE,
)
from ..state import RulesRecord, WorldRecord


def shows_pay(config: Config) -> bool:
    """Return whether observations of a configuration show what pays."""
    return config.reward == "score"


@inlined
def has_pay(rules: RulesRecord) -> bool:
    """Return whether observations of games with these rules show what pays."""
    return bool(rules.reward == SCORE)


@inner
def brick_pay(world: WorldRecord, cell: int) -> float:
    """Return what breaking a cell's brick pays, points / 1000, at most 1; 0 if nothing."""
    hits, kind = world.brick_hits[cell], world.kind[cell]
    if hits == 0 or hits == UNBREAKABLE or kind == EMPTY:
        return 0.0
    if kind == SILVER:
        return float(min(1.0, SILVER_POINTS * world.round_number * 0.001))
    return COLOUR_POINTS[kind - 1] * 0.001


@inner
def life_distance(world: WorldRecord) -> float:
    """Return the points that are missing to the next life / 60 000, in [0, 1]."""
    return float(max(0.0, min(1.0, (world.next_life - world.score) / EXTRA_LIFE_EVERY)))
