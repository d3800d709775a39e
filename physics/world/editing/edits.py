"""What edits do to a world between two steps. Each takes a body out, changes it, and puts it in."""

from ...kernels import kernel
from ..lookup.overrides import put_override
from ..lookup.tree import NO_ONE
from ..state.records import INDEX_BITS, OFF, ON, UNUSED, Block, Hits
from ..state.view import (
    WorldView,
    entries_of,
    first_inside_of,
    header_of,
    open_world,
    overrides_of,
    traits_of,
)
from .around import make_ready, put_in, take_out
from .endings import end_pairs, note_moved
from .slots import give_slot, place_of, take_slot

# A handle is an index in its low bits, and above it how many bodies had this index before.
NEXT_GENERATION = 1 << INDEX_BITS
LAST_HANDLE = (1 << 63) - NEXT_GENERATION  # from here on, an index is not used again


@kernel
def add_body(
    state: Block,
    inside: Block,
    workspace: Block,
    collider: int,
    boundless: bool,
    x: float,
    y: float,
    vx: float,
    vy: float,
    mass: float,
    inverse_mass: float,
    restitution: float,
    category: int,
    mask: int,
    is_sensor: bool,
) -> int:
    """Add a body, for which there is room; return its handle.

    Args:
        state, inside, workspace: of the world.
        collider: its index in the table of shapes.
        boundless: whether this has no bounds.
        x, y, vx, vy, mass, inverse_mass, restitution, category, mask, is_sensor: of the body.
    """
    world = open_world(state, inside, workspace)
    make_ready(world)
    header = header_of(world)
    header.living += 1
    body = header.free
    if body == NO_ONE:
        body = header.bodies
        header.bodies += 1
        entries_of(world)[body].handle = body
    else:
        header.free = entries_of(world)[body].next_free
    entry, trait = entries_of(world)[body], traits_of(world)[body]
    entry.state, entry.mass = ON, mass
    trait.collider, trait.boundless = collider, boundless
    trait.inverse_mass, trait.restitution = inverse_mass, restitution
    trait.category, trait.mask = category, mask
    trait.sensor = 0 if is_sensor else NO_ONE
    header.inelastic |= restitution == 0.0
    if header.sensors > 0:
        first_inside_of(world)[body] = NO_ONE
    trait.slot = NO_ONE
    _set_going(world, body, x, y, vx, vy, _moves(world, body, vx, vy))
    put_in(world, body)
    return int(entry.handle)


@kernel
def remove_body(state: Block, inside: Block, workspace: Block, body: int, ends: Hits) -> int:
    """Remove a body; return how many `END` events are in ``ends``, see `end_pairs`."""
    world = open_world(state, inside, workspace)
    make_ready(world)
    count = end_pairs(world, body, True, ends, 0)
    header, entry, trait = header_of(world), entries_of(world)[body], traits_of(world)[body]
    if entry.state == ON:
        _set_aside(world, body)
    entry.state = UNUSED
    trait.category = trait.mask = 0
    header.living -= 1
    if entry.handle < LAST_HANDLE:
        entry.handle += NEXT_GENERATION
        entry.next_free = header.free
        header.free = body
    return count


@kernel
def place_body(
    state: Block,
    inside: Block,
    workspace: Block,
    body: int,
    x: float,
    y: float,
    vx: float,
    vy: float,
    ends: Hits,
) -> int:
    """Place a body that is static or off, or begins or ceases to move; return as `remove_body`."""
    world = open_world(state, inside, workspace)
    if entries_of(world)[body].state == OFF:
        _set_going(world, body, x, y, vx, vy, False)
        return 0
    make_ready(world)
    _set_aside(world, body)
    _set_going(world, body, x, y, vx, vy, _moves(world, body, vx, vy))
    note_moved(world, body)
    put_in(world, body)
    return end_pairs(world, body, False, ends, 0)


@kernel
def change_body(
    state: Block,
    inside: Block,
    workspace: Block,
    body: int,
    is_on: bool,
    mass: float,
    inverse_mass: float,
    category: int,
    mask: int,
    is_sensor: bool,
    ends: Hits,
) -> int:
    """Change what a body is, all but its shape and restitution; return as `remove_body`."""
    world = open_world(state, inside, workspace)
    make_ready(world)
    entry, trait = entries_of(world)[body], traits_of(world)[body]
    x, y, vx, vy = place_of(world, body)
    becomes_other = is_sensor != (trait.sensor >= 0)
    count = 0
    if becomes_other or not is_on:
        count = end_pairs(world, body, True, ends, 0)
    if entry.state == ON:
        take_out(world, body)
    entry.state = ON if is_on else OFF
    entry.mass, trait.inverse_mass = mass, inverse_mass
    trait.category, trait.mask = category, mask
    trait.sensor = 0 if is_sensor else NO_ONE
    moves = is_on and _moves(world, body, vx, vy)
    if moves != (trait.slot != NO_ONE):
        if not moves:
            take_slot(world, body)
        _set_going(world, body, x, y, vx, vy, moves)
    if is_on:
        put_in(world, body)
        count = end_pairs(world, body, False, ends, count)
    return count


@kernel
def change_restitution(
    state: Block, inside: Block, workspace: Block, body: int, restitution: float
) -> None:
    """Give a body another restitution. No plan depends on it."""
    world = open_world(state, inside, workspace)
    traits_of(world)[body].restitution = restitution
    header_of(world).inelastic |= restitution == 0.0


@kernel
def change_override(
    state: Block, inside: Block, workspace: Block, low: int, high: int, restitution: float
) -> bool:
    """Give a pair of handles, low < high, its own restitution; return whether there was room.

    A restitution of nan takes it back.
    """
    world = open_world(state, inside, workspace)
    used = put_override(overrides_of(world), low, high, restitution)
    if used < 0:
        return False
    header_of(world).overrides_used += used
    header_of(world).inelastic |= restitution == 0.0
    return True


@kernel
def _set_aside(world: WorldView, body: int) -> None:
    """Take a body that is on out of the broad phase, and its slot from it."""
    take_out(world, body)
    if traits_of(world)[body].slot != NO_ONE:
        take_slot(world, body)


@kernel
def _moves(world: WorldView, body: int, vx: float, vy: float) -> bool:
    """Return whether a body with a velocity needs a slot."""
    return bool(traits_of(world)[body].inverse_mass > 0.0 or vx != 0.0 or vy != 0.0)


@kernel
def _set_going(
    world: WorldView, body: int, x: float, y: float, vx: float, vy: float, moves: bool
) -> None:
    """Let a body without a slot be somewhere, with a slot if it moves.

    If not, its velocity waits until it does: it is off, or the velocity is 0.
    """
    trait, entry = traits_of(world)[body], entries_of(world)[body]
    trait.home_x, trait.home_y = x, y
    entry.vx, entry.vy = vx, vy
    if moves:
        give_slot(world, body, x, y, vx, vy)
