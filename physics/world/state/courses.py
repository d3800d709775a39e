"""Where moving bodies are: each flies straight on from where it last changed its course."""

from ...kernels import kernel
from ...pairs.touching import touch_margins
from ...tolerances import NO_WAY, SLIDE, TOUCH
from .clock_time import elapsed
from .records import CourseRecord, TraitRecord
from .view import WorldView, edges_of, motions_of, plans_of, shapes_of, shown_of, traits_of


@kernel
def motion_at(
    world: WorldView, body: int, now: float, now_low: float
) -> tuple[float, float, float, float]:
    """Return (x, y, vx, vy) of a body at a time within the step."""
    trait = traits_of(world)[body]
    if trait.slot < 0:
        return trait.home_x, trait.home_y, 0.0, 0.0
    motion = motions_of(world)[trait.slot]
    x, y = place_at(motion, now, now_low)
    return x, y, motion.vx, motion.vy


@kernel
def place_at(motion: CourseRecord, now: float, now_low: float) -> tuple[float, float]:
    """Return the position (x, y) of a moving body at a time."""
    since = elapsed(now, now_low, motion.at, motion.at_low)
    return motion.x + motion.vx * since, motion.y + motion.vy * since


@kernel
def velocity_of(world: WorldView, slot: int) -> tuple[float, float]:
    """Return the velocity of the body with this slot; a static body (-1) has none."""
    if slot < 0:
        return 0.0, 0.0
    return motions_of(world)[slot].vx, motions_of(world)[slot].vy


@kernel
def shown_place(world: WorldView, trait: TraitRecord) -> tuple[float, float]:
    """Return the position (x, y) of a body between two steps."""
    if trait.slot < 0:
        return trait.home_x, trait.home_y
    motion = shown_of(world)[trait.slot]
    return motion.x, motion.y


@kernel
def move_to(world: WorldView, body: int, now: float, now_low: float) -> None:
    """Move a body to its position at a time within the step."""
    slot = traits_of(world)[body].slot
    if slot >= 0:
        motion, plan = motions_of(world)[slot], plans_of(world)[slot]
        x, y, _, _ = motion_at(world, body, now, now_low)
        way = abs(x - motion.x) + abs(y - motion.y)
        size = _size_of(world, body)
        plan.nowhere = not way > max(NO_WAY * size, TOUCH * (abs(x) + abs(y)))
        if not plan.nowhere:
            plan.series = 0
        if 2.0 * way > SLIDE * size:
            plan.rests = 0
        motion.x, motion.y = x, y
        motion.at, motion.at_low = now, now_low


@kernel
def short_way(world: WorldView, body: int) -> float:
    """Return how far a body may slide before it looks again what it slides into."""
    return float(SLIDE * _size_of(world, body))


@kernel
def is_short_way(world: WorldView, body: int) -> bool:
    """Return whether a body went next to nowhere when it was moved last, or has no mass."""
    trait = traits_of(world)[body]
    return bool(trait.inverse_mass == 0.0 or plans_of(world)[trait.slot].nowhere)


@kernel
def _size_of(world: WorldView, body: int) -> float:
    """Return the width or the height of a body, whichever is less."""
    shape = shapes_of(world)[traits_of(world)[body].collider]
    return float(min(shape.upper_x - shape.lower_x, shape.upper_y - shape.lower_y))


@kernel
def margins_of(
    world: WorldView, a: int, b: int, ax: float, ay: float, bx: float, by: float
) -> tuple[float, float]:
    """Return the margins (along x, along y) of body a at (ax, ay) and body b at (bx, by)."""
    traits = traits_of(world)
    return touch_margins(
        shapes_of(world), edges_of(world), traits[a].collider, traits[b].collider, ax, ay, bx, by
    )
