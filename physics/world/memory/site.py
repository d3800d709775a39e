"""One world as kernels see it: its blocks of bytes, and the edits that may need larger ones."""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from ...body import Body, FloatArray
from ...errors import InseparableError
from ...shapes.colliders import Collider
from ..editing.edits import (
    add_body,
    change_body,
    change_override,
    change_restitution,
    place_body,
    remove_body,
)
from ..lookup.inside import FEW_PAIRS, inside_block, pairs_inside
from ..lookup.tree import NO_ONE
from ..state.records import (
    INDEX_MASK,
    NEW,
    OFF,
    PLANNED,
    UNPLANNED,
    UNUSED,
    Clock,
    Course,
    Grid,
    Hit,
    Inside,
    Motion,
    Plan,
)
from .separable import inseparable_pair
from .setup import ByteArray, Setup

NO_HITS: npt.NDArray[Any] = np.zeros(0, Hit)
# What is kept of moving bodies when all else is made again.
MOTIONS = {"shown": Motion, "shown_after_step": Motion, "motions": Course}


class Stepping(Protocol):
    """What steps a site."""

    has_pending: bool

    def halt(self) -> None:
        """Ask for the blocks' addresses before it goes on."""


class Site:
    """The blocks of one world.

    Args:
        setup: what only edits change; perhaps other worlds use it, too.
        states: uint8 [worlds, bytes], of which one row is this world's.
        row: its index.
        part: worlds of one part may share a setup; others are stepped by another thread.

    Attributes:
        setup: see above. It is this world's own from the first edit on.
        state: uint8 [bytes], what steps change.
        inside: uint8 [bytes], who is inside which sensor.
        pending: `Hit` [n], the ends that edits have caused: the next step's first events.
        steppers: all that step this world.
        family: the worlds whose states are in one matrix.
        row, part: see above.
        capped: int64 [1], how often a body had used up its hits.
        warned: the same when the user was last warned of it.
    """

    def __init__(self, setup: Setup, states: ByteArray, row: int, part: int) -> None:
        self.setup = setup
        self.row, self.part = row, part
        self.steppers: list[Stepping] = []
        self.family: Family
        self.warned = 0
        self.pending = NO_HITS
        self.inside = inside_block(np.zeros((0, 3), np.int64), self.heads(), FEW_PAIRS)
        self.use_state(states[row])

    def use_state(self, state: ByteArray) -> None:
        """Use another row of a matrix as the state."""
        self.halt()
        self.state = state
        clocks = state[: Clock.itemsize].view(Clock)
        self.clock: Any = clocks[0]
        self.capped: npt.NDArray[np.int64] = clocks["capped"]
        self.motions: FloatArray = self.setup.motion_view(state[None])[0]

    def halt(self) -> None:
        """Let all that step this world ask for the blocks' addresses before they go on."""
        for stepper in self.steppers:
            stepper.halt()

    def heads(self) -> int:
        """Return how many bodies the block of what is inside has room for."""
        return self.setup.room.bodies if self.setup.header.sensors else 0

    # What there is.

    @property
    def living(self) -> npt.NDArray[np.int64]:
        """The indices of the bodies, int64 [n]."""
        return np.flatnonzero(self.setup.uses[: int(self.setup.header.bodies)] != UNUSED)

    def places(self, indices: npt.NDArray[np.int64], first: int) -> FloatArray:
        """Return the positions (first = 0) or velocities (2) of bodies, float64 [n, 2]."""
        setup = self.setup
        places: FloatArray = (setup.speeds if first else setup.homes)[indices]
        slots = setup.slots[indices]
        moves = slots != NO_ONE
        places[moves] = self.motions[slots[moves], first : first + 2]
        return places

    def place_of(self, index: int) -> list[float]:
        """Return x, y, vx, vy of a body."""
        slot = self.setup.slots.item(index)
        if slot != NO_ONE:
            found: list[float] = self.motions[slot].tolist()
            return found
        return [*self.setup.homes[index].tolist(), *self.setup.speeds[index].tolist()]

    def body(self, index: int) -> Body:
        """Return a body as it is now."""
        trait, mass = self.setup.traits[index], float(self.setup.entries[index]["mass"])
        x, y, vx, vy = self.place_of(index)
        collider = self.setup.colliders[trait["collider"]]
        finite_mass = None if mass == np.inf else mass
        return Body(collider, (x, y), (vx, vy), finite_mass, float(trait["restitution"]))

    def forget_check(self) -> None:
        """Let the next `check` look at the bodies again."""
        self.setup.is_checked = False
        self.halt()

    def check(self) -> None:
        """Prepare a step; raise an InseparableError if nothing separates bodies that bounce."""
        if self.clock.planned == NEW and not self.setup.is_tuned:
            self._tune()
        if not self.setup.is_checked:
            pair = inseparable_pair(self.setup)
            if pair is not None:
                raise InseparableError(*(self.body(index) for index in pair))
            self.setup.is_checked = True

    def _tune(self) -> None:
        """Let the lookup suit the bodies. Grids that a query has made do not fit then."""
        self.setup.is_tuned = True
        before = float(self.setup.header.cell)
        self.setup.tune()
        if self.setup.header.cell != before:
            for site in self.family.sites:
                if site.setup is self.setup:
                    site.unplan()

    # Edits.

    def _begin_edit(self) -> Setup:
        """Return the setup, which no other world uses from now on."""
        if self.setup.users > 1:
            own = self.setup.copy()
            self.halt()
            self.setup.users -= 1
            self.setup = own
        self.setup.is_tuned = False
        return self.setup

    def _after_edit(self, is_boundless: bool, ends: npt.NDArray[Any] | None = None) -> None:
        """Keep the ends that an edit has caused; ask again what nothing separates."""
        if is_boundless:
            self.forget_check()
        if ends is not None and len(ends):
            ends = np.concatenate([self.pending, ends])
            index = [ends[name] & INDEX_MASK for name in ("b", "a")]
            self.pending = ends[np.lexsort(index)]
            for stepper in self.steppers:
                stepper.has_pending = True

    def _ends(self) -> npt.NDArray[Any]:
        """Return room for all that may be no longer inside, `Hit` [n]."""
        count = int(self.inside[: Inside.itemsize].view(Inside)["count"][0])
        return np.zeros(count, Hit) if count else NO_HITS

    def add(
        self,
        collider: Collider,
        motion: tuple[float, float, float, float],
        mass: float,
        inverse_mass: float,
        restitution: float,
        category: int,
        mask: int,
        is_sensor: bool,
    ) -> int:
        """Add a body; return its handle."""
        setup = self._begin_edit()
        if not setup.has_collider(collider):
            self.halt()
            setup.add_collider(collider)
        if setup.header.free == NO_ONE and setup.header.bodies == setup.room.bodies:
            self._make_room_for_bodies()
        if inverse_mass > 0.0 or motion[2] != 0.0 or motion[3] != 0.0:
            self._make_room_to_move()
        if is_sensor:
            self._begin_to_sense()
        number, is_boundless = setup.number_of(collider)
        handle = add_body(
            *(self.state, self.inside, setup.workspace, number, is_boundless, *motion),
            *(mass, inverse_mass, restitution, category, mask, is_sensor),
        )
        if is_boundless:
            self._after_edit(True)
        return int(handle)

    def remove(self, index: int) -> None:
        """Remove a body."""
        setup, ends = self._begin_edit(), self._ends()
        boundless = bool(setup.traits[index]["boundless"])
        count = remove_body(self.state, self.inside, setup.workspace, index, ends)
        self._after_edit(boundless, ends[:count])

    def place(self, index: int, motion: list[float]) -> None:
        """Put a body somewhere, with another velocity."""
        slot, moves = self.setup.slots.item(index), motion[2] != 0.0 or motion[3] != 0.0
        if slot != NO_ONE and (moves or self.setup.inverse_masses.item(index) > 0.0):
            self.motions[slot] = motion
            return
        setup, ends = self._begin_edit(), self._ends()
        if moves and setup.entries[index]["state"] != OFF:
            self._make_room_to_move()
        x, y, vx, vy = motion
        count = place_body(self.state, self.inside, setup.workspace, index, x, y, vx, vy, ends)
        self._after_edit(bool(setup.traits[index]["boundless"]), ends[:count])

    def place_all(self, indices: npt.NDArray[np.int64], motions: FloatArray) -> None:
        """Do the same for several bodies; motions: float64 [n, 4]."""
        slots = self.setup.slots[indices]
        moves = (motions[:, 2:] != 0.0).any(axis=1) | (self.setup.inverse_masses[indices] > 0.0)
        is_quick = (slots != NO_ONE) & moves
        self.motions[slots[is_quick]] = motions[is_quick]
        for index, motion in zip(indices[~is_quick].tolist(), motions[~is_quick], strict=True):
            self.place(index, motion.tolist())

    def change(
        self,
        index: int,
        is_on: bool,
        mass: float,
        inverse_mass: float,
        category: int,
        mask: int,
        is_sensor: bool,
    ) -> None:
        """Change whether a body is on, its mass, and its category, mask and whether it senses."""
        setup, ends = self._begin_edit(), self._ends()
        if is_on and setup.traits[index]["slot"] == NO_ONE:
            self._make_room_to_move()
        if is_sensor:
            self._begin_to_sense()
        count = change_body(
            *(self.state, self.inside, setup.workspace, index, is_on, mass, inverse_mass),
            *(category, mask, is_sensor, ends),
        )
        self._after_edit(bool(setup.traits[index]["boundless"]), ends[:count])

    def set_restitution(self, index: int, restitution: float) -> None:
        """Give a body another restitution."""
        workspace = self._begin_edit().workspace
        change_restitution(self.state, self.inside, workspace, index, restitution)

    def override(self, low: int, high: int, restitution: float) -> None:
        """Give a pair of handles its own restitution; nan takes it back."""
        setup = self._begin_edit()
        if 2 * (int(setup.header.overrides_used) + 1) > setup.room.overrides:
            self.halt()
            setup.use_overrides(setup.overrides())
        change_override(self.state, self.inside, setup.workspace, low, high, restitution)

    def _make_room_for_bodies(self) -> None:
        pairs = pairs_inside(self.inside)
        self.halt()
        self.setup.resize(bodies=2 * self.setup.room.bodies)
        self.setup.tune()
        self.unplan()
        self.inside = inside_block(pairs, self.heads(), FEW_PAIRS + len(pairs))

    def _make_room_to_move(self) -> None:
        """Make room for one more body that moves."""
        if self.setup.header.movers == self.setup.room.movers:
            self.family.make_room_to_move(max(8, 2 * self.setup.room.movers))

    def _begin_to_sense(self) -> None:
        """Make room for sensors, if this is the first one."""
        if not self.setup.header.sensors:
            self.halt()
            self.setup.header.sensors = 1
            self.inside = inside_block(np.zeros((0, 3), np.int64), self.heads(), FEW_PAIRS)

    def make_room_inside(self) -> bool:
        """Make room for more pairs of a sensor and a body inside; return whether there was none."""
        inside = self.inside[: Inside.itemsize].view(Inside)[0]
        is_full = bool(self.setup.header.sensors and inside["free"] == NO_ONE)
        if is_full:
            pairs = pairs_inside(self.inside)
            self.halt()
            self.inside = inside_block(pairs, self.heads(), FEW_PAIRS + len(pairs))
        return is_full

    def unplan(self) -> None:
        """Let all plans and boxes be made again; a new world has none."""
        start = int(self.setup.header.grid_at)
        self.state[start : start + Grid.itemsize].view(Grid)["ready"] = 0
        if self.clock.planned == PLANNED:
            self.clock.planned = UNPLANNED


class Family:
    """Worlds whose states are the rows of one matrix: those of a batch, or a single one.

    Attributes:
        sites: the worlds.
        states: uint8 [worlds, bytes].
    """

    def __init__(self, setups: Sequence[Setup], parts: Sequence[int]) -> None:
        self.states = setups[0].new_states(len(setups))
        self.sites = [
            Site(setup, self.states, row, part)
            for row, (setup, part) in enumerate(zip(setups, parts, strict=True))
        ]
        for setup in setups:
            setup.users = 0
        for site in self.sites:
            site.setup.users += 1
            site.family = self
            site.clock.planned = NEW

    @property
    def movers_room(self) -> int:
        """How many moving bodies there is room for in each world."""
        return self.sites[0].setup.room.movers

    def make_room_to_move(self, movers: int) -> None:
        """Let all worlds have room for so many moving bodies."""
        setups = {id(site.setup): site.setup for site in self.sites}
        kept = [carried(site) for site in self.sites]
        for site in self.sites:
            site.halt()
        for setup in setups.values():
            setup.resize(movers=movers)
        self.states = self.sites[0].setup.new_states(len(self.sites))
        for site, own in zip(self.sites, kept, strict=True):
            site.use_state(self.states[site.row])
            write_carried(site, own)


def carried(site: Site) -> tuple[Any, ...]:
    """Return copies of what remains of a state when all else is made again."""
    records = site.setup.records
    return (
        site.state[: Clock.itemsize].copy(),
        *(records(site.state, name, dtype).copy() for name, dtype in MOTIONS.items()),
        records(site.state, "plans", Plan).copy(),
    )


def write_carried(site: Site, kept: tuple[Any, ...]) -> None:
    """Write what `carried` returned into another state, of which all else is made again."""
    clock, *motions, plans = kept
    site.state[: Clock.itemsize] = clock
    for (name, dtype), motion in zip(MOTIONS.items(), motions, strict=True):
        site.setup.records(site.state, name, dtype)[:] = motion
    site.setup.records(site.state, "plans", Plan)[:] = plans
    site.unplan()


def copied(site: Site, count: int, parts: int) -> Family:
    """Return copies of a world, in so many parts. The copies of a part share a setup.

    Each world has room for those bodies that move, and no more.
    """
    number = np.sort(np.arange(count) * parts // count)
    movers = int(site.setup.header.movers)
    own = [site.setup.copy(movers=movers) for _ in range(parts)]
    family = Family([own[part] for part in number], number.tolist())
    kept = carried(site)
    for twin in family.sites:
        write_carried(twin, kept)
        twin.inside = site.inside.copy()
        twin.pending = site.pending.copy()
    return family
