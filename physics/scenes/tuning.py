"""Lets the lookup of a world suit its bodies, as `Setup.tune` does. No bit depends on it."""

import math
from typing import Any

from ..kernels import kernel
from ..world.lookup.boxes import typical_margin, typical_width
from ..world.lookup.grid import SPARE
from ..world.state.records import FEW_MOVING, NEW, UNUSED
from ..world.state.view import (
    WorldView,
    clock_of,
    entries_of,
    grid_of,
    header_of,
    shapes_of,
    traits_of,
)


@kernel
def tune(world: WorldView, scratch: Any) -> None:
    """Choose the cells of a world by its bodies, as they were put in, until it is stepped.

    Args:
        world: the world.
        scratch: float64 [bodies].
    """
    if clock_of(world).planned != NEW:
        return
    count = _sort_measures(world, scratch, 0)
    typical = _quantile(scratch, count, 0.5) if count > 0 else 1.0
    apart = 0.0
    bounded = _sort_measures(world, scratch, 1)
    if bounded >= FEW_MOVING:
        width = _middle_half(scratch, bounded)
        _sort_measures(world, scratch, 2)
        apart = math.sqrt(width * _middle_half(scratch, bounded) / bounded)
    header = header_of(world)
    before = header.cell
    header.typical = typical
    header.margin = typical_margin(typical, apart)
    header.cell = typical_width(typical, header.margin) * (1.0 + 4.0 * SPARE)
    if header.cell != before:
        grid_of(world).ready = 0


@kernel
def _sort_measures(world: WorldView, scratch: Any, what: int) -> int:
    """Write a measure of all bodies with bounds in order; return how many there are.

    Args:
        world, scratch: see `tune`.
        what: 0: the sizes of those that have one; 1 and 2: x and y.
    """
    entries, traits, shapes = entries_of(world), traits_of(world), shapes_of(world)
    count = 0
    for body in range(traits.shape[0]):
        trait = traits[body]
        if entries[body].state == UNUSED or trait.boundless:
            continue
        shape = shapes[trait.collider]
        measure = max(max(-shape.lower_x, shape.upper_x), max(-shape.lower_y, shape.upper_y))
        if what == 0 and measure == 0.0:
            continue
        if what > 0:
            measure = trait.home_x if what == 1 else trait.home_y
        place = count
        while place > 0 and scratch[place - 1] > measure:
            scratch[place] = scratch[place - 1]
            place -= 1
        scratch[place] = measure
        count += 1
    return count


@kernel
def _middle_half(values: Any, count: int) -> float:
    """Return twice the distance of the quartiles of ordered values."""
    return 2.0 * (_quantile(values, count, 0.75) - _quantile(values, count, 0.25))


@kernel
def _quantile(values: Any, count: int, share: float) -> float:
    """Return a quantile of ordered values, between the two next to it, as NumPy rounds it."""
    place = share * (count - 1)
    low = int(place)
    part = place - low
    first, second = values[low], values[min(low + 1, count - 1)]
    if part >= 0.5:
        return float(second - (second - first) * (1.0 - part))
    return float(first + (second - first) * part)
