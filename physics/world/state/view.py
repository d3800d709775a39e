"""A world while it is stepped: views of the tables in its three blocks of bytes."""

from typing import Any, NamedTuple

from ...kernels import accessor
from ...kernels.borrowed import INDEX, anchor, borrowed
from ...shapes.records import Edge, Edges, Shape, Shapes
from .progress import Member, Members, Progress, ProgressRecord, Touch, Touches
from .records import (
    Block,
    Box,
    Boxes,
    Clock,
    ClockRecord,
    Course,
    Courses,
    Entries,
    Entry,
    Grid,
    GridRecord,
    Header,
    HeaderRecord,
    Indices,
    Inside,
    InsideRecord,
    Motion,
    Motions,
    Node,
    Nodes,
    Override,
    Overrides,
    Pair,
    Pairs,
    Plan,
    Plans,
    Seat,
    Seats,
    Trait,
    Traits,
    Tree,
    TreeRecord,
)

CLOCK_SIZE = Clock.itemsize
INSIDE_SIZE = Inside.itemsize
LEVELS = 64  # of the grid of moving bodies
LINKS = 32  # of a moving body: those that it may meet before it leaves its box
STACK = 128  # of a search in a tree; a tree of that height would have more leaves than memory


class WorldView(NamedTuple):
    """A world while it is stepped: the anchors of its three blocks, see `records`."""

    state: Any
    inside: Any
    workspace: Any


@accessor
def open_world(state: Block, inside: Block, workspace: Block) -> WorldView:
    """Return the view of a world whose state is one row of the states."""
    return WorldView(anchor(state), anchor(inside), anchor(workspace))


@accessor
def clock_of(world: WorldView) -> ClockRecord:
    """Return the `Clock`."""
    return borrowed(world.state, 0, 1, Clock)[0]


@accessor
def shown_of(world: WorldView) -> Motions:
    """Return the motions that users see and write between two steps, `Motion` [movers]."""
    return borrowed(world.state, CLOCK_SIZE, header_of(world).movers, Motion)


@accessor
def shown_after_step_of(world: WorldView) -> Motions:
    """Return what users saw at the end of the last step, `Motion` [movers]."""
    header = header_of(world)
    return borrowed(world.state, header.shown_after_step_at, header.movers, Motion)


@accessor
def motions_of(world: WorldView) -> Courses:
    """Return the courses of the moving bodies, `Course` [movers]."""
    header = header_of(world)
    return borrowed(world.state, header.motions_at, header.movers, Course)


@accessor
def plans_of(world: WorldView) -> Plans:
    """Return the plans of the moving bodies, `Plan` [movers]."""
    header = header_of(world)
    return borrowed(world.state, header.plans_at, header.movers, Plan)


@accessor
def winners_of(world: WorldView) -> Seats:
    """Return the tournament of the plans, `Seat` [2 * leaves]."""
    header = header_of(world)
    return borrowed(world.state, header.winners_at, 2 * header.leaves, Seat)


@accessor
def boxes_of(world: WorldView) -> Boxes:
    """Return the boxes of the moving bodies, `Box` [movers]."""
    header = header_of(world)
    return borrowed(world.state, header.boxes_at, header.movers, Box)


@accessor
def links_of(world: WorldView) -> Indices:
    """Return the lists of bodies that moving ones may meet, int64 [LINKS * movers]."""
    header = header_of(world)
    return borrowed(world.state, header.links_at, LINKS * header.movers, INDEX)


@accessor
def list_of(world: WorldView, slot: int) -> Indices:
    """Return the list of one of them, int64 [LINKS]."""
    start = header_of(world).links_at + 8 * LINKS * slot
    return borrowed(world.state, start, LINKS, INDEX)


@accessor
def grid_of(world: WorldView) -> GridRecord:
    """Return the `Grid` of these boxes."""
    return borrowed(world.state, header_of(world).grid_at, 1, Grid)[0]


@accessor
def level_counts_of(world: WorldView) -> Indices:
    """Return how many bodies are on each level of the grid, int64 [LEVELS]."""
    return borrowed(world.state, header_of(world).level_counts_at, LEVELS, INDEX)


@accessor
def heads_of(world: WorldView) -> Indices:
    """Return the first slot in the list of each bucket of cells, or -1: int64, a power of two."""
    header = header_of(world)
    return borrowed(world.state, header.heads_at, header.heads, INDEX)


@accessor
def inside_of(world: WorldView) -> InsideRecord:
    """Return the `Inside` record."""
    return borrowed(world.inside, 0, 1, Inside)[0]


@accessor
def first_inside_of(world: WorldView) -> Indices:
    """Return for each body its first pair with a sensor that it is inside, or -1: int64 [bodies].

    For a sensor, it is the first pair with a body inside it. There are none without sensors.
    """
    header = header_of(world)
    return borrowed(world.inside, INSIDE_SIZE, header.bodies if header.sensors > 0 else 0, INDEX)


@accessor
def pairs_of(world: WorldView) -> Pairs:
    """Return the `Pair` records, [room]."""
    room = inside_of(world).room
    header = header_of(world)
    heads = header.bodies_room if header.sensors > 0 else 0
    return borrowed(world.inside, INSIDE_SIZE + 8 * heads, room, Pair)


@accessor
def header_of(world: WorldView) -> HeaderRecord:
    """Return the `Header`."""
    return borrowed(world.workspace, 0, 1, Header)[0]


@accessor
def traits_of(world: WorldView) -> Traits:
    """Return the bodies' `Trait` records, [bodies]."""
    header = header_of(world)
    return borrowed(world.workspace, header.traits_at, header.bodies, Trait)


@accessor
def entries_of(world: WorldView) -> Entries:
    """Return the bodies' `Entry` records, [bodies]."""
    header = header_of(world)
    return borrowed(world.workspace, header.entries_at, header.bodies, Entry)


@accessor
def shapes_of(world: WorldView) -> Shapes:
    """Return the distinct `Shape` records."""
    header = header_of(world)
    return borrowed(world.workspace, header.shapes_at, header.shapes, Shape)


@accessor
def edges_of(world: WorldView) -> Edges:
    """Return the `Edge` records of the shapes."""
    header = header_of(world)
    return borrowed(world.workspace, header.edges_at, header.edges, Edge)


@accessor
def moving_of(world: WorldView) -> Indices:
    """Return the body of each slot, int64 [movers]."""
    header = header_of(world)
    return borrowed(world.workspace, header.moving_at, header.movers, INDEX)


@accessor
def boundless_of(world: WorldView) -> Indices:
    """Return the bodies without bounds, int64."""
    header = header_of(world)
    return borrowed(world.workspace, header.boundless_at, header.boundless, INDEX)


@accessor
def static_tree_of(world: WorldView) -> TreeRecord:
    """Return the `Tree` of the static bodies' boxes."""
    return borrowed(world.workspace, header_of(world).static_tree_at, 1, Tree)[0]


@accessor
def static_nodes_of(world: WorldView) -> Nodes:
    """Return its nodes, `Node`; the first half are the static bodies' boxes, by body."""
    header = header_of(world)
    return borrowed(world.workspace, header.static_nodes_at, header.static_nodes, Node)


@accessor
def overrides_of(world: WorldView) -> Overrides:
    """Return the restitutions of single pairs, a hash table of `Override` records."""
    header = header_of(world)
    return borrowed(world.workspace, header.overrides_at, header.overrides, Override)


@accessor
def progress_of(world: WorldView) -> ProgressRecord:
    """Return the `Progress`."""
    return borrowed(world.workspace, header_of(world).progress_at, 1, Progress)[0]


@accessor
def near_of(world: WorldView) -> Indices:
    """Return scratch memory for the bodies that one may meet, int64 [bodies + 1]."""
    header = header_of(world)
    return borrowed(world.workspace, header.near_at, header.bodies + 1, INDEX)


@accessor
def found_of(world: WorldView) -> Indices:
    """Return scratch memory for the slots that a search in the grid finds, int64 [bodies + 1]."""
    header = header_of(world)
    return borrowed(world.workspace, header.found_at, header.bodies + 1, INDEX)


@accessor
def stale_of(world: WorldView) -> Indices:
    """Return scratch memory for the slots whose plans no longer hold, int64 [movers]."""
    header = header_of(world)
    return borrowed(world.workspace, header.stale_at, header.movers, INDEX)


@accessor
def order_of(world: WorldView) -> Indices:
    """Return scratch memory for the moving bodies in order, int64 [movers]."""
    header = header_of(world)
    return borrowed(world.workspace, header.order_at, header.movers, INDEX)


@accessor
def places_of(world: WorldView) -> Indices:
    """Return each slot's place in `members_of` plus one, or 0: int64 [movers]."""
    header = header_of(world)
    return borrowed(world.workspace, header.places_at, header.movers, INDEX)


@accessor
def members_of(world: WorldView) -> Members:
    """Return scratch memory for the bodies that are resolved together, `Member` [room]."""
    header = header_of(world)
    return borrowed(world.workspace, header.members_at, header.members, Member)


@accessor
def touches_of(world: WorldView) -> Touches:
    """Return scratch memory for where they touch, `Touch` [room]."""
    header = header_of(world)
    return borrowed(world.workspace, header.touches_at, header.touches, Touch)


@accessor
def stack_of(world: WorldView) -> Indices:
    """Return scratch memory for a search in a tree, int64 [STACK]."""
    return borrowed(world.workspace, header_of(world).stack_at, STACK, INDEX)
