"""The paddle: the player moves it, and nothing else does."""

from ...physics.kernels import inlined, inner
from ..rules import BREAK_POINTS, FIELD_WIDTH
from ..state import RulesRecord, WorldRecord
from .scoring import add_score


@inner
def _inside(world: WorldRecord, x: float) -> float:
    """Return the place nearest to x at which the paddle is between the walls."""
    return float(max(world.paddle_half, min(FIELD_WIDTH - world.paddle_half, x)))


@inlined
def steer_paddle(world: WorldRecord, rules: RulesRecord) -> None:
    """Set the paddle's velocity for this tick; the paddle goes no further than the wall."""
    target = world.paddle_x + world.move * rules.paddle_speed
    world.paddle_vx = _inside(world, target) - world.paddle_x


@inner
def keep_paddle_inside(world: WorldRecord) -> None:
    """Move a paddle that has just become longer between the walls, and stop it there."""
    target = _inside(world, world.paddle_x + world.paddle_vx)
    world.paddle_x = _inside(world, world.paddle_x)
    world.paddle_vx = target - world.paddle_x


@inlined
def move_paddle(world: WorldRecord) -> None:
    """Move the paddle by one tick."""
    world.paddle_x += world.paddle_vx


@inlined
def leave_by_exit(world: WorldRecord, rules: RulesRecord) -> None:
    """Clear the round if the player pushes on through the open gate in the right wall."""
    if world.paddle_x + world.move * rules.paddle_speed > FIELD_WIDTH - world.paddle_half:
        world.cleared = 1
        add_score(world, BREAK_POINTS)
