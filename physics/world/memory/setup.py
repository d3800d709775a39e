"""The workspace that worlds are stepped in: tables with room to grow, one after the other."""

from typing import Any, NamedTuple, cast

import numpy as np
import numpy.typing as npt

from ...body import FloatArray
from ...kernels.layouts import aligned_bytes, in_lines
from ...shapes.colliders import Collider
from ...shapes.records import Edge, Shape
from ...shapes.table import shape_table
from ..lookup.boxes import enter_all_static, spacing, typical_margin, typical_width
from ..lookup.grid import SPARE
from ..lookup.overrides import override_table
from ..lookup.tree import NO_ONE
from ..plans.tournament import leaf_count
from ..state.progress import Member, Progress, Touch
from ..state.records import (
    FEW_MOVING,
    ON,
    UNUSED,
    Box,
    Course,
    Entry,
    Grid,
    Header,
    Motion,
    Node,
    Override,
    Plan,
    Seat,
    Trait,
    Tree,
)
from ..state.view import CLOCK_SIZE, LEVELS, LINKS, STACK

ByteArray = npt.NDArray[np.uint8]

# Bodies that can be resolved together, and touches of each of them that there is room for. Of a
# larger group, the rest is resolved after the first part.
LARGEST_GROUP = 512
TOUCHES = 4
MOST_TABLES = 16  # of shapes that queries ask about, kept for the next query
# What a larger workspace takes over of a smaller one's header.
_KEPT = (
    *("bodies", "living", "free", "movers", "sensors", "max_hits", "rest_speed"),
    *("continuous", "inelastic"),
    *("typical", "margin", "cell", "has_grid", "shapes", "edges", "boundless", "overrides_used"),
)


class Room(NamedTuple):
    """How many items there is room for in the tables of a workspace and of a state."""

    bodies: int
    movers: int
    shapes: int
    edges: int
    overrides: int = 0  # a power of two, or 0


class Setup:
    """What only edits change of one or several worlds, and the memory in which they are stepped.

    Args:
        room: of the tables.
        max_hits: of one body in one step.
        rest_speed: the speed up to which a pair meets without restitution.
        continuous: with times of impact, not by the lecture's procedure.

    Attributes:
        workspace, header: uint8 [bytes], see `records`, and its `Header`.
        users: how many worlds use it.
        is_tuned, is_checked: whether it suits the bodies, and all of them can be separated.
        colliders: all that any body had, in the order of the table of shapes.
        traits, entries: `Trait` and `Entry` [room].
        slots, inverse_masses, homes: of the traits, in columns, as they are asked fastest.
        numbers, uses, speeds: of the entries, the handles, the states and (vx, vy).
    """

    def __init__(self, room: Room, max_hits: int, rest_speed: float, continuous: bool) -> None:
        self.users = 1
        self.colliders: list[Collider] = []
        self._numbers: dict[Collider, int] = {}
        self._boundless: list[bool] = []
        self._tables: dict[Collider, tuple[ByteArray, ByteArray]] = {}
        self._use(room, _new_workspace(room))
        header = self.header
        header.max_hits, header.rest_speed = max_hits, rest_speed
        header.continuous = continuous
        header.free = NO_ONE
        self.tune()
        enter_all_static(self.workspace)

    def _use(self, room: Room, workspace: ByteArray) -> None:
        """Use another workspace, with this room."""
        self.is_tuned = self.is_checked = False
        self.room, self.workspace = room, workspace
        self.header: Any = workspace[: Header.itemsize].view(Header)[0]
        self.traits: npt.NDArray[Any] = self.table("traits", Trait, room.bodies)
        self.entries: npt.NDArray[Any] = self.table("entries", Entry, room.bodies)
        self.slots, self.inverse_masses = self.traits["slot"], self.traits["inverse_mass"]
        self.numbers, self.uses = self.entries["handle"], self.entries["state"]
        self.homes, self.speeds = _pairs(self.traits, "home_x"), _pairs(self.entries, "vx")

    def table(self, name: str, dtype: Any, count: int) -> npt.NDArray[Any]:
        """Return a view of the first items of a table, by its name in the header."""
        start = int(self.header[f"{name}_at"])
        return self.workspace[start : start + dtype.itemsize * count].view(dtype)

    @property
    def shapes(self) -> npt.NDArray[Any]:
        """The distinct `Shape` records."""
        return self.table("shapes", Shape, int(self.header.shapes))

    @property
    def edges(self) -> npt.NDArray[Any]:
        """The `Edge` records of the shapes."""
        return self.table("edges", Edge, int(self.header.edges))

    @property
    def moving(self) -> npt.NDArray[np.int64]:
        """The body of each slot, int64 [movers]."""
        return self.table("moving", np.dtype(np.int64), int(self.header.movers))

    def copy(self, **room: int) -> "Setup":
        """Return a setup of the same bodies, perhaps with other room than this one."""
        twin = object.__new__(Setup)
        twin.users = 1
        twin.colliders = self.colliders.copy()
        twin._numbers = self._numbers.copy()
        twin._boundless = self._boundless.copy()
        twin._tables = {}
        workspace = aligned_bytes(1, len(self.workspace))[0]
        workspace[:] = self.workspace
        twin._use(self.room, workspace)
        if room:
            twin.resize(**room)
        return twin

    def resize(self, **changes: int) -> None:
        """Make more room in tables. What is in them stays, but for the restitutions of pairs."""
        room = self.room._replace(**changes)
        old = object.__new__(Setup)
        old._use(self.room, self.workspace)
        self._use(room, _new_workspace(room))
        for name in _KEPT:
            self.header[name] = old.header[name]
        for name, dtype, count in _tables(old):
            if name == "overrides" and room.overrides != old.room.overrides:
                continue  # Each pair has another place in a table of another length.
            self.table(name, dtype, count)[:] = old.table(name, dtype, count)
        if room.bodies > old.room.bodies:
            self._spread_nodes(old.table("static_nodes", Node, 2 * old.room.bodies))

    def _spread_nodes(self, old: npt.NDArray[Any]) -> None:
        """Take over the tree's nodes from a smaller table, of which the second half moves."""
        nodes = self.table("static_nodes", Node, 2 * self.room.bodies)
        tree = self.table("static_tree", Tree, 1)
        before, shift = len(old) // 2, self.room.bodies - len(old) // 2
        nodes[:before], nodes[self.room.bodies :][:before] = old[:before], old[before:]
        for table, names in ((nodes, ("parent", "left", "right")), (tree, ("root", "free"))):
            for name in names:
                table[name] += np.where(table[name] >= before, shift, 0)
        # The new inner nodes come before the unused ones that there were.
        first, last = self.room.bodies + before, 2 * self.room.bodies - 1
        nodes["parent"][first:last] = np.arange(first + 1, last + 1)
        nodes["parent"][last], tree["free"] = tree["free"][0], first

    def tune(self) -> None:
        """Let boxes and the grid's cells suit the bodies and their distance. No bit depends on it.

        The distance of moving bodies is that of the places where they began to move.
        """
        bodies = int(self.header.bodies)
        own = self.traits[:bodies][(self.entries["state"] != UNUSED)[:bodies]]
        sizes = _sizes_of(self.shapes[own["collider"]])
        extended = sizes[(sizes > 0.0) & np.isfinite(sizes)]
        typical = float(np.median(extended)) if len(extended) else 1.0
        margin = typical_margin(typical, spacing(own[np.isfinite(sizes)]))
        self.header.typical, self.header.margin = typical, margin
        self.header.cell = typical_width(typical, margin) * (1.0 + 4.0 * SPARE)

    def has_collider(self, collider: Collider) -> bool:
        """Return whether a collider is in the table of shapes."""
        return collider in self._numbers

    def add_collider(self, collider: Collider) -> None:
        """Append a collider to the table of shapes."""
        shape, edges = shape_table([collider])
        header, count = self.header, int(shape["count"][0])
        shapes, used = int(header.shapes), int(header.edges)
        if shapes == self.room.shapes or used + len(edges) > self.room.edges:
            more = max(2 * self.room.edges, used + len(edges))
            self.resize(shapes=2 * self.room.shapes, edges=more)
            header = self.header
        shape["first"] += used
        self.table("shapes", Shape, shapes + 1)[shapes:] = shape
        self.table("edges", Edge, used + count)[used:] = edges[:count]
        header.shapes, header.edges = shapes + 1, used + count
        self._tables.clear()
        self._boundless.append(not have_bounds(shape)[0])
        self._numbers[collider] = shapes
        self.colliders.append(collider)

    def number_of(self, collider: Collider) -> tuple[int, bool]:
        """Return a collider's place in the table of shapes, and whether it has no bounds."""
        number = self._numbers[collider]
        return number, self._boundless[number]

    def tables_with(self, collider: Collider) -> tuple[ByteArray, ByteArray]:
        """Return (shapes, edges) with one more shape at the end, as bytes, for queries."""
        if collider not in self._tables:
            if len(self._tables) == MOST_TABLES:
                self._tables.clear()
            shape, own_edges = shape_table([collider])
            shape["first"] += len(self.edges)
            shapes, edges = (self.shapes, shape), (self.edges, own_edges)
            self._tables[collider] = (
                np.concatenate([part.view(np.uint8) for part in shapes]),
                np.concatenate([part.view(np.uint8) for part in edges]),
            )
        return self._tables[collider]

    def overrides(self) -> npt.NDArray[Any]:
        """Return the pairs of living bodies that have their own restitution, `Override` [n]."""
        table = self.table("overrides", Override, self.room.overrides)
        kept = table[(table["a"] >= 0) & ~np.isnan(table["restitution"])]
        handles = self.entries["handle"]
        for name in ("a", "b"):
            index = kept[name] & ((1 << 32) - 1)
            kept = kept[(handles[index] == kept[name]) & (self.entries["state"][index] != UNUSED)]
        ordered: npt.NDArray[Any] = kept[np.lexsort((kept["b"], kept["a"]))]
        return ordered

    def use_overrides(self, pairs: npt.NDArray[Any]) -> None:
        """Use these restitutions of pairs, `Override` [n], with room for as many more."""
        table = override_table(pairs)
        if len(table) != self.room.overrides:
            self.resize(overrides=len(table))
        self.table("overrides", Override, len(table))[:] = table
        self.header.overrides_used = len(pairs)

    def use_bodies(
        self,
        traits: npt.NDArray[Any],
        entries: npt.NDArray[Any],
        overrides: npt.NDArray[Any],
    ) -> None:
        """Use these bodies, `Trait` and `Entry` [n], and restitutions of pairs, `Override` [n].

        The header says already how many bodies there are, and how many of them move.
        """
        self.traits[: len(traits)], self.entries[: len(entries)] = traits, entries
        header, index = self.header, np.dtype(np.int64)
        header.living = (entries["state"] != UNUSED).sum()
        header.has_grid = header.movers > FEW_MOVING
        moving = np.flatnonzero(traits["slot"] != NO_ONE)
        self.moving[traits["slot"][moving]] = moving
        boundless = np.flatnonzero((traits["boundless"] == 1) & (entries["state"] == ON))
        header.boundless = len(boundless)
        self.table("boundless", index, len(boundless))[:] = boundless
        self.use_overrides(overrides)
        self.table("progress", Progress, 1).view(np.uint8)[:] = 0
        self.table("places", index, self.room.movers)[:] = 0
        self.tune()
        enter_all_static(self.workspace)

    def new_states(self, worlds: int) -> ByteArray:
        """Return zeroed states, uint8 [worlds, bytes]."""
        return aligned_bytes(worlds, int(self.header.state_size))

    def motion_view(self, states: ByteArray) -> FloatArray:
        """Return a view of the motions, float64 [worlds, room, 4]: x, y, vx, vy.

        They are those that users see and may write between two steps.
        """
        end = CLOCK_SIZE + Motion.itemsize * self.room.movers
        part: FloatArray = states[:, CLOCK_SIZE:end].view(np.float64)
        return part.reshape(len(states), self.room.movers, 4)

    def records(self, state: ByteArray, name: str, dtype: Any) -> npt.NDArray[Any]:
        """Return a view of records of the moving bodies, [movers].

        Args:
            state: uint8 [bytes].
            name: of the part: "shown", or as in the header "shown_after_step", "motions", "plans".
            dtype: of the records.
        """
        start = CLOCK_SIZE if name == "shown" else int(self.header[f"{name}_at"])
        return state[start : start + dtype.itemsize * int(self.header.movers)].view(dtype)


def _pairs(records: npt.NDArray[Any], name: str) -> FloatArray:
    """Return a view of a field of records and the one after it, float64 [n, 2]."""
    first = cast(Any, records.dtype.fields)[name][1]
    return np.ndarray((len(records), 2), np.float64, records, first, (records.itemsize, 8))


def _tables(setup: Setup) -> list[tuple[str, Any, int]]:
    """Return (name, dtype, used items) of the tables that a larger workspace takes over."""
    header, index = setup.header, np.dtype(np.int64)
    return [
        ("traits", Trait, int(header.bodies)),
        ("entries", Entry, int(header.bodies)),
        ("shapes", Shape, int(header.shapes)),
        ("edges", Edge, int(header.edges)),
        ("moving", index, int(header.movers)),
        ("boundless", index, int(header.boundless)),
        ("static_tree", Tree, 1),
        ("static_nodes", Node, 2 * setup.room.bodies),
        ("overrides", Override, setup.room.overrides),
    ]


def _sizes_of(shapes: npt.NDArray[Any]) -> FloatArray:
    """Return how far shapes reach from their origin along the axes, float64 [n]."""
    sides = [np.abs(shapes[name]) for name in ("lower_x", "lower_y", "upper_x", "upper_y")]
    return np.asarray(np.max(sides, axis=0))


def have_bounds(shapes: npt.NDArray[Any]) -> npt.NDArray[np.bool_]:
    """Return which shapes have bounds, bool [n]."""
    return np.isfinite(_sizes_of(shapes))


def _new_workspace(room: Room) -> ByteArray:
    """Return an empty workspace with this room."""
    header = np.zeros(1, Header)
    for name in ("bodies", "movers", "shapes", "edges"):
        header[f"{name}_room"] = getattr(room, name)
    header["overrides"], header["static_nodes"] = room.overrides, 2 * room.bodies
    group = min(room.movers, LARGEST_GROUP)
    header["members"], header["touches"] = group, TOUCHES * (group + 2) + 1
    _plan_state(header, room.movers)
    index = np.dtype(np.int64)
    parts: dict[str, tuple[Any, int]] = {
        "traits": (Trait, room.bodies),
        "entries": (Entry, room.bodies),
        "shapes": (Shape, room.shapes),
        "edges": (Edge, room.edges),
        "moving": (index, room.movers),
        "boundless": (index, room.bodies),
        "static_tree": (Tree, 1),
        "static_nodes": (Node, 2 * room.bodies),
        "overrides": (Override, room.overrides),
        "progress": (Progress, 1),
        "near": (index, room.bodies + 1),
        "found": (index, room.bodies + 1),
        "stale": (index, room.movers),
        "order": (index, room.movers),
        "places": (index, room.movers),
        "members": (Member, group),
        "touches": (Touch, TOUCHES * (group + 2) + 1),
        "stack": (index, STACK),
    }
    at = in_lines(header.nbytes)
    for name, (dtype, count) in parts.items():
        header[f"{name}_at"] = at
        at += in_lines(dtype.itemsize * count)
    workspace: ByteArray = aligned_bytes(1, at)[0]
    workspace[: header.nbytes] = header.view(np.uint8)
    return workspace


def _plan_state(header: npt.NDArray[Any], movers: int) -> None:
    """Write into a header where the parts of a state for so many movers begin."""
    header["leaves"] = leaf_count(movers)
    header["heads"] = 2 * header["leaves"]
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
