"""From bodies to the workspace that steps them: traits, shapes, and the grid of static bodies."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arguments import inverse_mass
from ..body import FloatArray
from ..pairs.table import contact_between
from ..shapes.colliders import Collider
from ..shapes.records import Edge, Shape
from ..shapes.table import shape_table
from ..tolerances import TOUCH
from .grid import NO_ONE, count_cells, fill_cells
from .records import Header, Motion, Override, Plan, Progress, Trait
from .tournament import leaf_count
from .view import CLOCK_SIZE

ByteArray = npt.NDArray[np.uint8]

# Cells per body. More of them are crossed more often, fewer hold more neighbours each.
CELLS_PER_MOVING = 2.0
CELLS_PER_STATIC = 0.5
# With so few bodies there is only one cell; with so few moving ones, no lists of them.
FEW_BODIES = 8
# A moving body that is so many times larger than the median roams. A static body in more than this
# share of all cells is tested everywhere instead.
LARGE = 8.0
MANY_CELLS = 0.25
# Cells are larger than the largest body by this fraction, because of rounding.
MARGIN = 1e-6


@dataclass(frozen=True)
class BodySpec:
    """What a world keeps of a body, besides its position and velocity."""

    collider: Collider
    mass: float | None
    restitution: float
    category: int
    mask: int
    is_sensor: bool


@dataclass(frozen=True)
class Setup:
    """All of a world but its state.

    Attributes:
        workspace: uint8 [bytes], see `records`.
        moving: int64 [movers], the bodies that move, in the order of their motions.
        sensing: int64 [sensors], the sensors.
        shapes, edges: the table of the distinct colliders.
        traits: `Trait` [bodies].
    """

    workspace: ByteArray
    moving: npt.NDArray[np.int64]
    sensing: npt.NDArray[np.int64]
    shapes: npt.NDArray[Any]
    edges: npt.NDArray[Any]
    traits: npt.NDArray[Any]

    def new_state(self, num_worlds: int) -> ByteArray:
        """Return zeroed states, uint8 [num_worlds, bytes]."""
        return np.zeros((num_worlds, self.header.state_size), np.uint8)

    @property
    def header(self) -> Any:
        """The `Header`."""
        return self.workspace[: Header.itemsize].view(Header)[0]

    def motion_view(self, states: ByteArray) -> FloatArray:
        """Return a view of the motions, float64 [num_worlds, movers, 4]: x, y, vx, vy."""
        part: FloatArray = states[:, CLOCK_SIZE : self.header.motions_after_step_at].view(
            np.float64
        )
        return part.reshape(len(states), len(self.moving), 4)

    def motions_after_step_view(self, states: ByteArray) -> FloatArray:
        """Return a view of the motions after the last step, as from `motion_view`."""
        part: FloatArray = states[:, self.header.motions_after_step_at : self.header.plans_at].view(
            np.float64
        )
        return part.reshape(len(states), len(self.moving), 4)

    def inside_view(self, states: ByteArray) -> ByteArray:
        """Return a view of which bodies are inside, uint8 [num_worlds, sensors, bodies]."""
        size = len(self.sensing) * len(self.traits)
        part = states[:, self.header.inside_at : self.header.inside_at + size]
        return part.reshape(len(states), len(self.sensing), len(self.traits))


def build_setup(
    specs: Sequence[BodySpec],
    positions: FloatArray,
    velocities: FloatArray,
    overrides: Mapping[tuple[int, int], float],
    max_hits: int,
    continuous: bool,
) -> Setup:
    """Return the setup of a world.

    Args:
        specs: the bodies.
        positions: float64 [n, 2].
        velocities: float64 [n, 2].
        overrides: the restitution of single pairs (a, b), a < b.
        max_hits: of one body in one step.
        continuous: with times of impact, not by the lecture's procedure.
    """
    index: dict[Collider, int] = {}
    for spec in specs:
        index.setdefault(spec.collider, len(index))
    shapes, edges = shape_table(index)
    traits = np.zeros(len(specs), Trait)
    for trait, spec in zip(traits, specs, strict=True):
        trait.collider = index[spec.collider]
        trait.inverse_mass = inverse_mass("mass", spec.mass)
        trait.restitution = spec.restitution
        trait.category = spec.category
        trait.mask = spec.mask
        trait.sensor = 0 if spec.is_sensor else NO_ONE
    traits["home_x"], traits["home_y"] = positions.T
    moves = (traits["inverse_mass"] > 0.0) | (velocities != 0.0).any(axis=1)
    moving, sensing = np.flatnonzero(moves), np.flatnonzero(traits["sensor"] == 0)
    traits["slot"] = NO_ONE
    traits["slot"][moving] = np.arange(len(moving))
    traits["sensor"][sensing] = np.arange(len(sensing))

    own = shapes[traits["collider"]]
    boxes = np.column_stack([own[name] for name in ("lower_x", "lower_y", "upper_x", "upper_y")])
    reach = np.abs(boxes).max(axis=1, initial=0.0)
    traits["roams"] = moves & _is_large(reach, moves)
    resident = moves & (traits["roams"] == 0)
    boxes += np.tile(positions, 2)
    header = np.zeros(1, Header)
    header["max_hits"], header["continuous"] = max_hits, continuous
    static = np.flatnonzero(~moves)
    boundless, firsts, entered = _make_grid(header, boxes, static, reach, resident, positions)
    pairs = np.array([(*pair, e) for pair, e in sorted(overrides.items())], Override)
    header["bodies"], header["movers"] = len(specs), len(moving)
    header["sensors"] = len(sensing)
    _plan_state(header, cells=len(firsts) - 1)
    workspace = _pack(
        header,
        traits=traits,
        shapes=shapes,
        edges=edges,
        moving=moving,
        sensing=sensing,
        roaming=np.flatnonzero(traits["roams"]),
        boundless=boundless,
        firsts=firsts,
        items=entered,
        overrides=pairs,
        progress=np.zeros(1, Progress),
        near=np.zeros(len(specs), np.int64),
        stale=np.zeros(len(moving), np.int64),
    )
    return Setup(workspace, moving, sensing, shapes, edges, traits)


def inseparable_pair(setup: Setup) -> tuple[int, int] | None:
    """Return two bodies that have to bounce and that no finite translation separates, or None."""
    traits, shapes = setup.traits, setup.shapes
    reach = np.array([max(-s.lower_x, -s.lower_y, s.upper_x, s.upper_y) for s in shapes])
    open_ones = np.flatnonzero(np.isinf(reach[traits["collider"]]) & (traits["sensor"] < 0))
    for a in open_ones[traits["slot"][open_ones] >= 0]:
        for b in open_ones:
            one, other = traits[a], traits[b]
            meets = one["category"] & other["mask"] and other["category"] & one["mask"]
            if a == b or not meets or one["inverse_mass"] + other["inverse_mass"] == 0.0:
                continue
            pair = int(one["collider"]), int(other["collider"])
            depth = contact_between(shapes, setup.edges, *pair, 0.0, 0.0)[3]
            if depth == math.inf:
                return int(a), int(b)
    return None


def _is_large(reach: FloatArray, moves: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Return which bodies are too large for a cell if they move, bool [n]."""
    bounded = reach[moves & np.isfinite(reach)]
    typical = float(np.median(bounded)) if len(bounded) else 0.0
    return ~(reach <= LARGE * typical)


def _make_grid(
    header: npt.NDArray[Any],
    boxes: FloatArray,
    static: npt.NDArray[np.int64],
    reach: FloatArray,
    resident: npt.NDArray[np.bool_],
    positions: FloatArray,
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Choose the grid's cells, and enter static bodies; return (boundless, firsts, items)."""
    furthest = float(reach[resident].max(initial=0.0)) * (1.0 + MARGIN)
    bounded = static[np.isfinite(boxes[static]).all(axis=1)]
    corners = np.concatenate(
        [boxes[bounded, :2], boxes[bounded, 2:], positions[resident], np.zeros((0, 2))]
    )
    count = len(bounded) + int(resident.sum())
    header["columns"] = header["rows"] = 1
    header["cell"] = 1.0
    if count > FEW_BODIES:
        low, high = corners.min(axis=0), corners.max(axis=0)
        size = np.maximum(high - low, 1e-300)
        cells = max(1.0, CELLS_PER_STATIC * len(bounded) + CELLS_PER_MOVING * resident.sum())
        cell = max(2.0 * furthest, math.sqrt(size[0] / cells) * math.sqrt(size[1]))
        # The field may be almost a line.
        cell = max(cell, float(size.max()) / (4.0 * cells))
        header["left"], header["bottom"], header["cell"] = low[0], low[1], cell
        header["columns"], header["rows"] = np.maximum(1, np.ceil(size / cell)).astype(int)
    # A point on the border of two bodies touches both, whatever rounding says.
    furthest += 4.0 * TOUCH * float(np.abs(corners).max(initial=0.0))
    cells = int(header["columns"][0] * header["rows"][0])
    covered = np.zeros(len(boxes), np.int64)
    covered[:] = NO_ONE
    covered[bounded] = 0
    counts = np.zeros(cells + 1, np.int64)
    count_cells(header, boxes, furthest, covered, counts)
    # Bodies that are nearly everywhere would only fill the lists.
    wide = bounded[covered[bounded] > max(4.0, MANY_CELLS * cells)]
    if len(wide):
        covered[wide] = NO_ONE
        counts[:] = 0
        count_cells(header, boxes, furthest, covered, counts)
    entered = np.flatnonzero(covered > 0)
    boundless = np.setdiff1d(static, entered)
    firsts = np.cumsum(counts)
    items = np.zeros(firsts[-1], np.int64)
    fill_cells(header, boxes[entered], furthest, entered, firsts[:-1].copy(), items)
    return boundless, firsts, items


def _plan_state(header: npt.NDArray[Any], cells: int) -> None:
    """Write into a header where the parts of the state begin."""
    movers = int(header["movers"][0])
    header["leaves"] = leaf_count(movers)
    header["heads"] = cells if movers > FEW_BODIES else 0
    sizes = {
        "motions_after_step_at": CLOCK_SIZE + Motion.itemsize * movers,
        "plans_at": Motion.itemsize * movers,
        "winners_at": Plan.itemsize * movers,
        "heads_at": 8 * 2 * header["leaves"][0],
        "inside_at": 8 * header["heads"][0],
        "state_size": -(-header["sensors"][0] * header["bodies"][0] // 8) * 8,
    }
    end = 0
    for name, size in sizes.items():
        end += int(size)
        header[name] = end


def _pack(header: npt.NDArray[Any], **parts: npt.NDArray[Any]) -> ByteArray:
    """Return one block: the header, into which offsets and lengths are written, and the parts."""
    at = header.nbytes
    for name, part in parts.items():
        header[f"{name}_at"] = at
        if name in (header.dtype.names or ()):
            header[name] = len(part)
        at += part.nbytes
    blocks = [header, *parts.values()]
    return np.concatenate([block.view(np.uint8).ravel() for block in blocks])


def with_query(setup: Setup, collider: Collider) -> tuple[Any, Any]:
    """Return (shapes, edges) of a setup with one more shape at the end."""
    shape, own_edges = shape_table([collider])
    shape["first"] += len(setup.edges)
    shapes: npt.NDArray[Any] = np.concatenate([setup.shapes, shape]).view(Shape)
    edges: npt.NDArray[Any] = np.concatenate([setup.edges, own_edges]).view(Edge)
    return shapes, edges
