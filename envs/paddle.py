"""The paddle: it is pushed by the player, and nothing else moves it."""

from typing import Any

from ..physics.compilation import kernel
from .rules import FIELD_WIDTH


@kernel
def steer_paddle(world: Any, rules: Any) -> None:
    """Set the paddle's velocity for this tick, so that it ends at the wall at the furthest."""
    target = world.paddle_x + world.move * rules.paddle_speed
    target = max(rules.paddle_half, min(FIELD_WIDTH - rules.paddle_half, target))
    world.paddle_vx = target - world.paddle_x


@kernel
def move_paddle(world: Any) -> None:
    """Move the paddle by one tick."""
    world.paddle_x += world.paddle_vx
