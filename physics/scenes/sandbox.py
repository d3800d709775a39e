"""A world to throw things in: the edits, steps and questions of `World`, for a page.

It has room for a fixed number of bodies. The shape of a body lies in the row of its index, so the
table of shapes never grows; the row after these is for questions.
"""

from typing import Any

import numpy as np

from ..kernels import accessor, kernel
from ..kernels.borrowed import BYTE, INDEX
from ..kernels.portable import array_at
from ..shapes.records import Edge, Shape
from ..world.editing.edits import (
    add_body,
    change_body,
    change_restitution,
    place_body,
    remove_body,
)
from ..world.editing.slots import place_of
from ..world.lookup.boxes import enter_all_static
from ..world.lookup.inside import has_free_pair
from ..world.lookup.tree import NO_ONE
from ..world.queries.finding import EDGE_SIZE, RAY_SIZE, SHAPE_SIZE, find_first, find_overlapping
from ..world.state.records import INDEX_MASK, NEW, ON, UNUSED, Hit, Ray
from ..world.state.view import (
    INSIDE_SIZE,
    WorldView,
    clock_of,
    edges_of,
    entries_of,
    header_of,
    inside_of,
    moving_of,
    open_world,
    pairs_of,
    shapes_of,
    shown_of,
    traits_of,
)
from ..world.stepping.step import CALL_BLOCKS, CALL_START, INVALID, step_worlds
from .patterns import TURNS
from .placing import outline_figure, place_figure
from .records import MAX_EDGES, RAYS, Seen
from .tuning import tune

CALL = CALL_START + CALL_BLOCKS
ALL = -1  # categories

# What became of a step.
DONE = 0
MORE = 1  # there was no more room for hits: it goes on
CROWDED = 2  # more is inside sensors than there is room for
LOST = 3  # a number has become too large

_FLOAT = np.dtype(np.float64)


@accessor
def _block(address: int, size: int) -> Any:
    return array_at(address, (size,), BYTE)


@accessor
def _open(sandbox: Any) -> WorldView:
    return open_world(
        _block(sandbox.state, sandbox.state_size),
        _block(sandbox.inside, sandbox.inside_size),
        _block(sandbox.workspace, sandbox.workspace_size),
    )


@kernel
def begin_sandbox(sandbox: Any) -> None:
    """Make an empty world; its workspace begins with a header, and all else is zero."""
    world = _open(sandbox)
    enter_all_static(_block(sandbox.workspace, sandbox.workspace_size))
    clock_of(world).planned = NEW
    header = header_of(world)
    for body in range(header.bodies_room):
        shapes_of(world)[body].first = MAX_EDGES * body
    call = array_at(sandbox.call, (CALL,), INDEX)
    call[0], call[1], call[2] = 1, 0, 0
    call[3], call[4] = sandbox.hits, sandbox.hits_room
    call[5], call[6] = sandbox.state, sandbox.state_size
    call[7], call[8] = sandbox.inside, sandbox.inside_size
    call[9], call[10] = sandbox.workspace, sandbox.workspace_size


@kernel
def _tune(sandbox: Any, world: WorldView) -> None:
    tune(world, array_at(sandbox.scratch, (sandbox.room,), _FLOAT))


@kernel
def add_figure(sandbox: Any) -> None:
    """Add a body, and write its handle and its outline; a handle of -1 says that there is no room.

    What has no bounds has no mass: so any two bodies can be separated.
    """
    world, figure = _open(sandbox), sandbox.figure
    header = header_of(world)
    body = header.bodies if header.free == NO_ONE else header.free
    sandbox.handle = -1
    if body >= sandbox.room:
        return
    boundless = _place(sandbox, world, body)
    if sandbox.sensor:
        _begin_to_sense(sandbox, world)
    mass, inverse_mass = _masses(figure.mass, boundless)
    sandbox.handle = add_body(
        _block(sandbox.state, sandbox.state_size),
        _block(sandbox.inside, sandbox.inside_size),
        _block(sandbox.workspace, sandbox.workspace_size),
        body,
        boundless,
        figure.x,
        figure.y,
        figure.vx,
        figure.vy,
        mass,
        inverse_mass,
        figure.restitution,
        1,
        ALL,
        sandbox.sensor == 1,
    )


@kernel
def _place(sandbox: Any, world: WorldView, body: int) -> bool:
    """Write the shape and the outline of the figure; return whether it has no bounds."""
    figure = sandbox.figure
    patterns = array_at(sandbox.patterns, (sandbox.number_of_patterns,), Shape)
    pattern_edges = array_at(sandbox.pattern_edges, (sandbox.number_of_edges,), Edge)
    turns = array_at(sandbox.turns, (TURNS, 2), _FLOAT)
    shape, edges = shapes_of(world)[body], edges_of(world)
    place_figure(figure, patterns[figure.pattern], pattern_edges, turns, shape, edges)
    outline_figure(figure, shape, edges, array_at(sandbox.scratch, (sandbox.room,), _FLOAT))
    most = max(max(-shape.lower_x, shape.upper_x), max(-shape.lower_y, shape.upper_y))
    return bool(most == np.inf)


@kernel
def _masses(mass: float, boundless: bool) -> tuple[float, float]:
    """Return the mass and its inverse of what shall have a mass, or 0 for none."""
    if mass > 0.0 and not boundless:
        return mass, 1.0 / mass
    return np.inf, 0.0


@kernel
def _begin_to_sense(sandbox: Any, world: WorldView) -> None:
    """Make room for what is inside sensors, if this is the first one."""
    header, inside = header_of(world), inside_of(world)
    if header.sensors:
        return
    header.sensors = 1
    firsts = array_at(sandbox.inside + INSIDE_SIZE, (header.bodies_room,), INDEX)
    for body in range(header.bodies_room):
        firsts[body] = NO_ONE
    inside.count, inside.free, inside.room = 0, 0, sandbox.pairs
    pairs = pairs_of(world)
    for pair in range(sandbox.pairs):
        pairs[pair].sensor = NO_ONE
        pairs[pair].next = pair + 1 if pair + 1 < sandbox.pairs else NO_ONE


@kernel
def _find_body(sandbox: Any, world: WorldView) -> int:
    """Return the index of the body of the handle, or -1 if there is no such body."""
    body = sandbox.handle & INDEX_MASK
    if sandbox.handle < 0 or body >= header_of(world).bodies:
        return -1
    entry = entries_of(world)[body]
    if entry.handle != sandbox.handle or entry.state == UNUSED:
        return -1
    return int(body)


@kernel
def remove_figure(sandbox: Any) -> None:
    """Remove a body; ``count`` ends are in the hits."""
    sandbox.count = 0
    body = _find_body(sandbox, _open(sandbox))
    if body < 0:
        sandbox.handle = -1
        return
    sandbox.count = remove_body(
        _block(sandbox.state, sandbox.state_size),
        _block(sandbox.inside, sandbox.inside_size),
        _block(sandbox.workspace, sandbox.workspace_size),
        body,
        array_at(sandbox.hits, (sandbox.hits_room,), Hit),
    )


@kernel
def move_figure(sandbox: Any) -> None:
    """Put a body where the figure is, with its velocity; ``count`` ends are in the hits."""
    world, figure = _open(sandbox), sandbox.figure
    sandbox.count = 0
    body = _find_body(sandbox, world)
    if body < 0:
        sandbox.handle = -1
        return
    trait = traits_of(world)[body]
    moves = figure.vx != 0.0 or figure.vy != 0.0
    if trait.slot != NO_ONE and (moves or trait.inverse_mass > 0.0):
        seen = shown_of(world)[trait.slot]
        seen.x, seen.y, seen.vx, seen.vy = figure.x, figure.y, figure.vx, figure.vy
        return
    sandbox.count = place_body(
        _block(sandbox.state, sandbox.state_size),
        _block(sandbox.inside, sandbox.inside_size),
        _block(sandbox.workspace, sandbox.workspace_size),
        body,
        figure.x,
        figure.y,
        figure.vx,
        figure.vy,
        array_at(sandbox.hits, (sandbox.hits_room,), Hit),
    )


@kernel
def change_figure(sandbox: Any) -> None:
    """Give a body the figure's mass and restitution, and let it be a sensor or solid."""
    world, figure = _open(sandbox), sandbox.figure
    sandbox.count = 0
    body = _find_body(sandbox, world)
    if body < 0:
        sandbox.handle = -1
        return
    trait = traits_of(world)[body]
    mass, inverse_mass = _masses(figure.mass, bool(trait.boundless))
    workspace = _block(sandbox.workspace, sandbox.workspace_size)
    state = _block(sandbox.state, sandbox.state_size)
    inside = _block(sandbox.inside, sandbox.inside_size)
    change_restitution(state, inside, workspace, body, figure.restitution)
    if sandbox.sensor:
        _begin_to_sense(sandbox, world)
    sandbox.count = change_body(
        state,
        inside,
        workspace,
        body,
        entries_of(world)[body].state == ON,
        mass,
        inverse_mass,
        trait.category,
        trait.mask,
        sandbox.sensor == 1,
        array_at(sandbox.hits, (sandbox.hits_room,), Hit),
    )


@kernel
def step_sandbox(sandbox: Any) -> None:
    """Step the world, or go on with a step; ``count`` events are in the hits.

    Gravity changes the velocities before the step.
    """
    world = _open(sandbox)
    if not sandbox.goes_on:
        _tune(sandbox, world)
        _pull(world, sandbox.gravity * sandbox.dt)
    count = step_worlds(sandbox.call, 0, sandbox.dt, 1)
    sandbox.outcome = DONE
    if count == INVALID:
        sandbox.outcome, count = LOST, 0
    elif count < 0:
        sandbox.outcome, count = MORE if has_free_pair(world) else CROWDED, -1 - count
    sandbox.count = count
    sandbox.goes_on = 1 if sandbox.outcome == MORE else 0


@kernel
def _pull(world: WorldView, speed: float) -> None:
    """Let all that collisions move gain speed downwards."""
    if speed == 0.0:
        return
    moving, shown, traits = moving_of(world), shown_of(world), traits_of(world)
    for slot in range(moving.shape[0]):
        if traits[moving[slot]].inverse_mass > 0.0:
            shown[slot].vy -= speed


@kernel
def see_sandbox(sandbox: Any) -> None:
    """Write what there is: ``count`` bodies, in the order of their indices, and the sums."""
    world = _open(sandbox)
    bodies = array_at(sandbox.bodies, (sandbox.room,), Seen)
    traits, entries = traits_of(world), entries_of(world)
    sandbox.time, sandbox.capped = clock_of(world).time, clock_of(world).capped
    count = 0
    energy = momentum_x = momentum_y = 0.0
    for body in range(traits.shape[0]):
        entry, trait = entries[body], traits[body]
        if entry.state == UNUSED:
            continue
        seen = bodies[count]
        count += 1
        seen.handle, seen.mass, seen.restitution = entry.handle, entry.mass, trait.restitution
        seen.sensor = 1 if trait.sensor >= 0 else 0
        seen.x, seen.y, seen.vx, seen.vy = place_of(world, body)
        if trait.inverse_mass > 0.0:
            speed = seen.vx * seen.vx + seen.vy * seen.vy
            energy += seen.mass * (0.5 * speed + sandbox.gravity * seen.y)
            momentum_x += seen.mass * seen.vx
            momentum_y += seen.mass * seen.vy
    sandbox.count = count
    sandbox.energy, sandbox.momentum_x, sandbox.momentum_y = energy, momentum_x, momentum_y


@kernel
def find_figures(sandbox: Any) -> None:
    """Write the ``count`` handles of the bodies that overlap a disc, or contain a point."""
    world = _open(sandbox)
    _prepare_question(sandbox, world, sandbox.reach)
    header = header_of(world)
    sandbox.count = find_overlapping(
        _block(sandbox.state, sandbox.state_size),
        _block(sandbox.workspace, sandbox.workspace_size),
        _block(sandbox.workspace + header.shapes_at, SHAPE_SIZE * header.shapes),
        _block(sandbox.workspace + header.edges_at, EDGE_SIZE * header.edges),
        sandbox.x,
        sandbox.y,
        ALL,
        array_at(sandbox.found, (sandbox.room,), INDEX),
    )


@kernel
def look_around(sandbox: Any) -> None:
    """Send rays from a place in all directions, and write what each meets first."""
    world = _open(sandbox)
    _prepare_question(sandbox, world, 0.0)
    header = header_of(world)
    rays, turns = array_at(sandbox.rays, (RAYS,), Ray), array_at(sandbox.turns, (TURNS, 2), _FLOAT)
    for index in range(RAYS):
        turn = turns[index * TURNS // RAYS]
        rays[index].x, rays[index].y, rays[index].room = sandbox.x, sandbox.y, 0.0
        rays[index].way_x, rays[index].way_y = sandbox.reach * turn[0], sandbox.reach * turn[1]
    find_first(
        _block(sandbox.state, sandbox.state_size),
        _block(sandbox.workspace, sandbox.workspace_size),
        _block(sandbox.workspace + header.shapes_at, SHAPE_SIZE * header.shapes),
        _block(sandbox.workspace + header.edges_at, EDGE_SIZE * header.edges),
        _block(sandbox.rays, RAY_SIZE * RAYS),
        ALL,
    )


@kernel
def _prepare_question(sandbox: Any, world: WorldView, radius: float) -> None:
    """Write the shape that a question is about into the last row: a disc, or a point."""
    _tune(sandbox, world)
    shape = shapes_of(world)[sandbox.room]
    shape.radius = shape.upper_x = shape.upper_y = radius
    shape.lower_x = shape.lower_y = -radius
