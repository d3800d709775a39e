"""From a world's two blocks of bytes to the tables in them."""

from typing import Any, NamedTuple

from ..kernels import accessor
from ..kernels.borrowed import BYTES, INDICES, borrowed
from ..shapes.records import Edge, Shape
from .records import Clock, Header, Motion, Override, Plan, Progress, Trait

CLOCK = Clock.itemsize


class Memory(NamedTuple):
    """A world while it is stepped: uint8 [bytes] each, see `world_records`."""

    state: Any
    desk: Any


@accessor
def open_world(state: Any, desk: Any) -> Any:
    """Return the `Memory` of a world: its row of the states, and the desk."""
    return Memory(
        borrowed(state, 0, state.shape[0], BYTES), borrowed(desk, 0, desk.shape[0], BYTES)
    )


@accessor
def clock_of(world: Any) -> Any:
    """Return the `Clock`."""
    return borrowed(world.state, 0, 1, Clock)[0]


@accessor
def motions_of(world: Any) -> Any:
    """Return the `Motion` of what moves, [movers]."""
    return borrowed(world.state, CLOCK, header_of(world).movers, Motion)


@accessor
def left_as_of(world: Any) -> Any:
    """Return the motions as the last step left them, `Motion` [movers]."""
    header = header_of(world)
    return borrowed(world.state, header.left_as_at, header.movers, Motion)


@accessor
def plans_of(world: Any) -> Any:
    """Return the `Plan` of what moves, [movers]."""
    header = header_of(world)
    return borrowed(world.state, header.plans_at, header.movers, Plan)


@accessor
def winners_of(world: Any) -> Any:
    """Return the tournament of the plans, int64 [2 * leaves]."""
    header = header_of(world)
    return borrowed(world.state, header.winners_at, 2 * header.leaves, INDICES)


@accessor
def heads_of(world: Any) -> Any:
    """Return the slot that begins each cell's list of what moves, or -1: int64 [cells or none]."""
    header = header_of(world)
    return borrowed(world.state, header.heads_at, header.heads, INDICES)


@accessor
def inside_of(world: Any) -> Any:
    """Return for each sensor and each body whether it is inside, uint8 [sensors * bodies]."""
    header = header_of(world)
    return borrowed(world.state, header.inside_at, header.sensors * header.bodies, BYTES)


@accessor
def header_of(world: Any) -> Any:
    """Return the `Header`."""
    return borrowed(world.desk, 0, 1, Header)[0]


@accessor
def traits_of(world: Any) -> Any:
    """Return the bodies' `Trait` records, [bodies]."""
    header = header_of(world)
    return borrowed(world.desk, header.traits_at, header.bodies, Trait)


@accessor
def shapes_of(world: Any) -> Any:
    """Return the distinct `Shape` records."""
    header = header_of(world)
    return borrowed(world.desk, header.shapes_at, header.shapes, Shape)


@accessor
def edges_of(world: Any) -> Any:
    """Return the `Edge` records of the shapes."""
    header = header_of(world)
    return borrowed(world.desk, header.edges_at, header.edges, Edge)


@accessor
def moving_of(world: Any) -> Any:
    """Return the body of each slot, int64 [movers]."""
    header = header_of(world)
    return borrowed(world.desk, header.moving_at, header.movers, INDICES)


@accessor
def sensing_of(world: Any) -> Any:
    """Return the body of each sensor, int64 [sensors]."""
    header = header_of(world)
    return borrowed(world.desk, header.sensing_at, header.sensors, INDICES)


@accessor
def roaming_of(world: Any) -> Any:
    """Return the bodies that move and are too large for the grid, int64."""
    header = header_of(world)
    return borrowed(world.desk, header.roaming_at, header.roaming, INDICES)


@accessor
def boundless_of(world: Any) -> Any:
    """Return the static bodies that are too large for the grid, int64."""
    header = header_of(world)
    return borrowed(world.desk, header.boundless_at, header.boundless, INDICES)


@accessor
def firsts_of(world: Any) -> Any:
    """Return where each cell's part of the items begins, int64 [cells + 1]."""
    header = header_of(world)
    return borrowed(world.desk, header.firsts_at, header.columns * header.rows + 1, INDICES)


@accessor
def items_of(world: Any) -> Any:
    """Return the static bodies of one cell after the other, int64."""
    header = header_of(world)
    return borrowed(world.desk, header.items_at, header.items, INDICES)


@accessor
def overrides_of(world: Any) -> Any:
    """Return the `Override` records, by their bodies."""
    header = header_of(world)
    return borrowed(world.desk, header.overrides_at, header.overrides, Override)


@accessor
def progress_of(world: Any) -> Any:
    """Return the `Progress`."""
    return borrowed(world.desk, header_of(world).progress_at, 1, Progress)[0]


@accessor
def near_of(world: Any) -> Any:
    """Return room for who may be met, int64 [bodies]."""
    header = header_of(world)
    return borrowed(world.desk, header.near_at, header.bodies, INDICES)


@accessor
def stale_of(world: Any) -> Any:
    """Return room for whose plan is to be made anew, int64 [movers]."""
    header = header_of(world)
    return borrowed(world.desk, header.stale_at, header.movers, INDICES)
