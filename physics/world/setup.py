"""From bodies to the workspace that steps them: traits, shapes, and the tree of static bodies."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arguments import inverse_mass
from ..body import FloatArray
from ..kernels.layouts import aligned_bytes, in_lines
from ..pairs.table import contact_between
from ..shapes.colliders import Collider
from ..shapes.records import Edge, Shape
from ..shapes.table import shape_table
from .lookup.boxes import enter_static, typical_margin, typical_width
from .lookup.grid import SPARE
from .lookup.overrides import override_table
from .lookup.tree import NO_ONE
from .records import (
    Box,
    Course,
    Grid,
    Header,
    Member,
    Motion,
    Node,
    Plan,
    Progress,
    Seat,
    Touch,
    Trait,
    Tree,
)
from .tournament import leaf_count
from .view import CLOCK_SIZE, LEVELS, LINKS, STACK

ByteArray = npt.NDArray[np.uint8]

# With so few moving bodies there is no grid of them.
FEW_MOVING = 8
# Bodies that can be resolved together, and touches of each of them that there is room for. Of a
# larger group, the rest is resolved after the first part.
LARGEST_GROUP = 512
TOUCHES = 4


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
        return aligned_bytes(num_worlds, int(self.header.state_size))

    @property
    def header(self) -> Any:
        """The `Header`."""
        return self.workspace[: Header.itemsize].view(Header)[0]

    def motion_view(self, states: ByteArray) -> FloatArray:
        """Return a view of the motions, float64 [num_worlds, movers, 4]: x, y, vx, vy.

        They are those that users see and may write between two steps.
        """
        end = CLOCK_SIZE + Motion.itemsize * len(self.moving)
        part: FloatArray = states[:, CLOCK_SIZE:end].view(np.float64)
        return part.reshape(len(states), len(self.moving), 4)

    def records(self, states: ByteArray, name: str, dtype: Any) -> npt.NDArray[Any]:
        """Return a view of records of the moving bodies, [num_worlds, movers].

        Args:
            states: uint8 [num_worlds, bytes].
            name: of the part, as in the header: "shown_after_step", "motions" or "plans".
            dtype: of the records.
        """
        start = int(self.header[f"{name}_at"])
        size = dtype.itemsize * len(self.moving)
        return states[:, start : start + size].view(dtype)


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
    sizes = np.abs([own[name] for name in ("lower_x", "lower_y", "upper_x", "upper_y")]).max(axis=0)
    traits["boundless"] = ~_have_bounds(sizes)
    header = np.zeros(1, Header)
    header["max_hits"], header["continuous"] = max_hits, continuous
    header["inelastic"] = (traits["restitution"] == 0.0).any() or 0.0 in overrides.values()
    header["typical"] = _typical(sizes[traits["boundless"] == 0])
    typical = float(header["typical"][0])
    margin = typical_margin(typical, _spacing(positions[traits["boundless"] == 0]))
    header["margin"] = margin
    header["cell"] = typical_width(typical, margin) * (1.0 + 4.0 * SPARE)
    header["has_grid"] = len(moving) > FEW_MOVING
    header["bodies"], header["movers"] = len(specs), len(moving)
    header["sensors"] = len(sensing)
    _plan_state(header)
    is_tree = ~moves & (traits["boundless"] == 0)
    group = min(len(moving), LARGEST_GROUP)
    workspace = _pack(
        header,
        traits=traits,
        shapes=shapes,
        edges=edges,
        moving=moving,
        boundless=np.flatnonzero(traits["boundless"]),
        static_tree=np.zeros(1, Tree),
        static_nodes=np.zeros(2 * len(specs) if is_tree.any() else 0, Node),
        overrides=override_table(overrides),
        progress=np.zeros(1, Progress),
        near=np.zeros(len(specs) + 1, np.int64),
        found=np.zeros(len(specs) + 1, np.int64),
        stale=np.zeros(len(moving), np.int64),
        places=np.zeros(len(moving), np.int64),
        members=np.zeros(group, Member),
        touches=np.zeros(TOUCHES * (group + 2) + 1, Touch),
        stack=np.zeros(STACK, np.int64),
    )
    enter_static(workspace)
    return Setup(workspace, moving, sensing, shapes, edges, traits)


def _have_bounds(sizes: FloatArray) -> npt.NDArray[np.bool_]:
    """Return which bodies have bounds, if these are their sizes, bool [n]."""
    return np.isfinite(sizes)


def _typical(sizes: FloatArray) -> float:
    """Return a length that suits most bodies; 1 if all are points."""
    extended = sizes[sizes > 0.0]
    return float(np.median(extended)) if len(extended) else 1.0


def _spacing(positions: FloatArray) -> float:
    """Return how far bodies are apart, about where half of them are; 0 for a few or in a row."""
    if len(positions) < FEW_MOVING:
        return 0.0
    low, high = np.quantile(positions, (0.25, 0.75), axis=0)
    width, height = 2.0 * (high - low)
    return float(np.sqrt(width * height / len(positions)))


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


def _plan_state(header: npt.NDArray[Any]) -> None:
    """Write into a header where the parts of the state begin."""
    movers = int(header["movers"][0])
    header["leaves"] = leaf_count(movers)
    header["heads"] = 2 * header["leaves"] if header["has_grid"][0] else 0
    sizes = {
        "shown_after_step_at": CLOCK_SIZE + Motion.itemsize * movers,
        "motions_at": Motion.itemsize * movers,
        "plans_at": Course.itemsize * movers,
        "winners_at": Plan.itemsize * movers,
        "boxes_at": Seat.itemsize * 2 * header["leaves"][0],
        "links_at": Box.itemsize * movers,
        "grid_at": 8 * LINKS * movers,
        "level_counts_at": Grid.itemsize,
        "heads_at": 8 * LEVELS,
        "state_size": 8 * header["heads"][0],
    }
    end = 0
    for name, size in sizes.items():
        end = in_lines(end + int(size))
        header[name] = end


def _pack(header: npt.NDArray[Any], **parts: npt.NDArray[Any]) -> ByteArray:
    """Return one block: the header, into which offsets and lengths are written, and the parts."""
    at = in_lines(header.nbytes)
    for name, part in parts.items():
        header[f"{name}_at"] = at
        if name in (header.dtype.names or ()):
            header[name] = len(part)
        at += in_lines(part.nbytes)
    block: ByteArray = aligned_bytes(1, at)[0]
    block[: header.nbytes] = header.view(np.uint8)
    for name, part in parts.items():
        start = int(header[f"{name}_at"][0])
        block[start : start + part.nbytes] = part.view(np.uint8).ravel()
    return block


def with_query(setup: Setup, collider: Collider) -> tuple[Any, Any]:
    """Return (shapes, edges) of a setup with one more shape at the end."""
    shape, own_edges = shape_table([collider])
    shape["first"] += len(setup.edges)
    shapes: npt.NDArray[Any] = np.concatenate([setup.shapes, shape]).view(Shape)
    edges: npt.NDArray[Any] = np.concatenate([setup.edges, own_edges]).view(Edge)
    return shapes, edges
