"""A world while it is stepped: views of the tables in its two blocks of bytes."""

from typing import NamedTuple

from ..kernels import accessor
from ..kernels.borrowed import BYTE, INDEX, borrowed
from ..shapes.records import Edge, Edges, Shape, Shapes
from .records import (
    Block,
    Clock,
    ClockRecord,
    Flags,
    Header,
    HeaderRecord,
    Indices,
    Member,
    Members,
    Motion,
    Motions,
    Override,
    Overrides,
    Plan,
    Plans,
    Progress,
    ProgressRecord,
    Touch,
    Touches,
    Trait,
    Traits,
)

CLOCK_SIZE = Clock.itemsize


class WorldView(NamedTuple):
    """A world while it is stepped: its state and the workspace, see `records`."""

    state: Block
    workspace: Block


@accessor
def open_world(state: Block, workspace: Block) -> WorldView:
    """Return the view of a world whose state is one row of the states."""
    return WorldView(
        borrowed(state, 0, state.shape[0], BYTE), borrowed(workspace, 0, workspace.shape[0], BYTE)
    )


@accessor
def clock_of(world: WorldView) -> ClockRecord:
    """Return the `Clock`."""
    return borrowed(world.state, 0, 1, Clock)[0]


@accessor
def motions_of(world: WorldView) -> Motions:
    """Return the motions of the moving bodies, `Motion` [movers]."""
    return borrowed(world.state, CLOCK_SIZE, header_of(world).movers, Motion)


@accessor
def motions_after_step_of(world: WorldView) -> Motions:
    """Return the motions at the end of the last step, `Motion` [movers]."""
    header = header_of(world)
    return borrowed(world.state, header.motions_after_step_at, header.movers, Motion)


@accessor
def plans_of(world: WorldView) -> Plans:
    """Return the plans of the moving bodies, `Plan` [movers]."""
    header = header_of(world)
    return borrowed(world.state, header.plans_at, header.movers, Plan)


@accessor
def winners_of(world: WorldView) -> Indices:
    """Return the tournament of the plans, int64 [2 * leaves]."""
    header = header_of(world)
    return borrowed(world.state, header.winners_at, 2 * header.leaves, INDEX)


@accessor
def heads_of(world: WorldView) -> Indices:
    """Return the first slot in each cell's list of moving bodies, or -1: int64 [cells or 0]."""
    header = header_of(world)
    return borrowed(world.state, header.heads_at, header.heads, INDEX)


@accessor
def inside_of(world: WorldView) -> Flags:
    """Return for each sensor which bodies are inside, uint8 [sensors * bodies]."""
    header = header_of(world)
    return borrowed(world.state, header.inside_at, header.sensors * header.bodies, BYTE)


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
def sensing_of(world: WorldView) -> Indices:
    """Return the body of each sensor, int64 [sensors]."""
    header = header_of(world)
    return borrowed(world.workspace, header.sensing_at, header.sensors, INDEX)


@accessor
def roaming_of(world: WorldView) -> Indices:
    """Return the moving bodies that are too large for the grid, int64."""
    header = header_of(world)
    return borrowed(world.workspace, header.roaming_at, header.roaming, INDEX)


@accessor
def boundless_of(world: WorldView) -> Indices:
    """Return the static bodies that are too large for the grid, int64."""
    header = header_of(world)
    return borrowed(world.workspace, header.boundless_at, header.boundless, INDEX)


@accessor
def firsts_of(world: WorldView) -> Indices:
    """Return where each cell's part of `items_of` begins, int64 [cells + 1]."""
    header = header_of(world)
    return borrowed(world.workspace, header.firsts_at, header.columns * header.rows + 1, INDEX)


@accessor
def items_of(world: WorldView) -> Indices:
    """Return the static bodies, cell by cell, int64."""
    header = header_of(world)
    return borrowed(world.workspace, header.items_at, header.items, INDEX)


@accessor
def overrides_of(world: WorldView) -> Overrides:
    """Return the restitutions of single pairs, `Override` [pairs], sorted by their bodies."""
    header = header_of(world)
    return borrowed(world.workspace, header.overrides_at, header.overrides, Override)


@accessor
def progress_of(world: WorldView) -> ProgressRecord:
    """Return the `Progress`."""
    return borrowed(world.workspace, header_of(world).progress_at, 1, Progress)[0]


@accessor
def near_of(world: WorldView) -> Indices:
    """Return scratch memory for the bodies that one may meet, int64 [bodies]."""
    header = header_of(world)
    return borrowed(world.workspace, header.near_at, header.bodies, INDEX)


@accessor
def stale_of(world: WorldView) -> Indices:
    """Return scratch memory for the slots whose plans no longer hold, int64 [movers]."""
    header = header_of(world)
    return borrowed(world.workspace, header.stale_at, header.movers, INDEX)


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
