"""Worlds as bytes: their bodies with handles, their motions, and who is inside which sensor.

What follows from that is not kept, but made again: plans, boxes, trees. The worlds of a batch that
nobody has edited have the same bodies, which are kept once.
"""

import hashlib
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ...kernels.layouts import record_dtype
from ...kernels.sealed import seal, unseal
from ..lookup.inside import FEW_PAIRS, inside_block, pairs_inside
from ..state.records import UNPLANNED, Clock, Course, Entry, Hit, Motion, Override, Plan, Trait
from .checks import check_bodies, check_clocks, check_ends, check_motions, check_pairs, corrupt
from .setup import Setup
from .site import MOTIONS, Family, Site

VERSION = 4  # of the format
_MARK = b"ARKWORLD"
_DIGEST_SIZE = 16  # bytes

_INDEX = np.dtype(np.int64)
_TRIPLE = np.dtype((np.int64, 3))

# What is kept of a moving body.
Kept = record_dtype(
    [
        ("shown", Motion),
        ("shown_after_step", Motion),
        ("motions", Course),
    ]
)

# What is kept of a setup besides its tables.
Head = record_dtype(
    [
        ("max_hits", np.int64),
        ("rest_speed", np.float64),
        ("continuous", np.int64),
        ("shapes", np.int64),
        ("edges", np.int64),
        ("bodies", np.int64),
        ("movers", np.int64),
        ("overrides", np.int64),
        ("free", np.int64),
        ("sensors", np.int64),
        ("inelastic", np.int64),
    ]
)
_OF_HEADERS = ("bodies", "movers", "free", "sensors", "inelastic")  # what a restore sets
_ASKED = ("max_hits", "rest_speed", "continuous")  # what it must not change


class _Bodies(NamedTuple):
    """The bodies of a world, as they are read."""

    content: bytes
    head: Any
    traits: npt.NDArray[Any]
    entries: npt.NDArray[Any]
    overrides: npt.NDArray[Any]
    base: Setup


class _Reader:
    """Reads one table of a content after the other."""

    def __init__(self, content: memoryview) -> None:
        self.content = content
        self.at = 0

    def take(self, dtype: Any, count: int) -> npt.NDArray[Any]:
        """Return the next table, of so many items."""
        size = dtype.itemsize * int(count)
        if count < 0 or size > len(self.content) - self.at:
            raise corrupt("numbers of bodies")
        part = np.frombuffer(self.content, dtype, int(count), self.at)
        self.at += size
        return part


def pack(sites: Sequence[Site]) -> bytes:
    """Return worlds as a snapshot."""
    numbers: dict[bytes, int] = {}
    of_setups: dict[int, int] = {}
    for site in sites:
        if id(site.setup) not in of_setups:
            packed = _pack_bodies(site.setup)
            of_setups[id(site.setup)] = numbers.setdefault(packed, len(numbers))
    which = np.array([of_setups[id(site.setup)] for site in sites], np.int64)
    clocks = np.array([site.clock for site in sites], Clock)
    clocks["planned"] = UNPLANNED
    pairs = [pairs_inside(site.inside) for site in sites]
    counts = np.array(
        [[len(own), len(site.pending)] for own, site in zip(pairs, sites, strict=True)], np.int64
    )
    parts: list[Any] = [np.array([len(sites), len(numbers)]), *numbers, which, clocks]
    parts += [_kept(site) for site in sites]
    parts += [counts, *pairs, *(site.pending for site in sites)]
    content = b"".join(part if isinstance(part, bytes) else part.tobytes() for part in parts)
    return seal(_MARK, VERSION, content)


def _pack_bodies(setup: Setup) -> bytes:
    """Return the bodies of a setup."""
    header, overrides = setup.header, setup.overrides()
    bodies = int(header.bodies)
    head = np.zeros(1, Head)
    for name in (*_ASKED, *_OF_HEADERS):
        head[name] = header[name]
    head["overrides"] = len(overrides)
    # The shapes up to the last one in use: later ones may come of edits that were undone.
    shapes = int(setup.traits["collider"][:bodies].max(initial=-1)) + 1
    last = setup.shapes[:shapes][-1:]
    edges = int((last["first"] + last["count"]).sum())
    head["shapes"], head["edges"] = shapes, edges
    digest = _digest(setup, shapes, edges)
    tables = (setup.traits[:bodies], setup.entries[:bodies], overrides)
    return b"".join([head.tobytes(), digest, *(table.tobytes() for table in tables)])


def _digest(setup: Setup, shapes: int, edges: int) -> bytes:
    """Return a digest of the first shapes of a setup."""
    content = setup.shapes[:shapes].tobytes() + setup.edges[:edges].tobytes()
    return hashlib.sha256(content).digest()[:_DIGEST_SIZE]


def _kept(site: Site) -> npt.NDArray[Any]:
    """Return what is kept of the moving bodies of a world."""
    kept = np.zeros(int(site.setup.header.movers), Kept)
    for name, dtype in MOTIONS.items():
        kept[name] = site.setup.records(site.state, name, dtype)
    return kept


def unpack(snapshot: bytes, family: Family) -> None:
    """Let worlds be as they were when a snapshot was taken.

    Raises:
        TypeError: if it is not bytes.
        ValueError: if it is corrupt, of another version, or of another world or batch, or if no
            step or edit leaves a world like that. The worlds do not change then.
    """
    reader = _Reader(unseal("snapshot of worlds", _MARK, VERSION, snapshot))
    worlds, number = reader.take(_INDEX, 2).tolist()
    if worlds != len(family.sites):
        raise ValueError(f"the snapshot is of another number of worlds: {worlds}")
    if not 0 < number <= worlds:
        raise corrupt("numbers of bodies")
    bases = list({id(site.setup): site.setup for site in family.sites}.values())
    all_bodies = [_read_bodies(reader, bases) for _ in range(number)]
    which = reader.take(_INDEX, worlds)
    if ((which < 0) | (which >= number)).any():
        raise corrupt("numbers of bodies")
    clocks = reader.take(Clock, worlds)
    check_clocks(clocks)
    kept = [reader.take(Kept, all_bodies[own].head["movers"]) for own in which]
    for own, clock in zip(kept, clocks, strict=True):
        check_motions(own, clock)
    counts = reader.take(_INDEX, 2 * worlds).reshape(-1, 2)
    pairs = [reader.take(_TRIPLE, count) for count in counts[:, 0]]
    ends = [reader.take(Hit, count) for count in counts[:, 1]]
    if reader.at != len(reader.content):
        raise corrupt("numbers of bodies")
    for own, number in zip(pairs, which, strict=True):
        check_pairs(own, all_bodies[number].traits, all_bodies[number].entries)
    for own in ends:
        check_ends(own)
    setups = _setups_for(family, [all_bodies[number] for number in which])
    _use_setups(family, setups)
    for site, clock, own, inside, pending in zip(
        family.sites, clocks, kept, pairs, ends, strict=True
    ):
        _write(site, clock, own, inside, pending)


def _read_bodies(reader: _Reader, bases: Sequence[Setup]) -> _Bodies:
    """Read the bodies of a setup."""
    start = reader.at
    head = reader.take(Head, 1)[0]
    digest = reader.take(np.dtype(np.uint8), _DIGEST_SIZE).tobytes()
    traits, entries = reader.take(Trait, head["bodies"]), reader.take(Entry, head["bodies"])
    overrides = reader.take(Override, head["overrides"])
    shapes, edges = int(head["shapes"]), int(head["edges"])
    for base in bases:
        header = base.header
        fits = all(head[name] == header[name] for name in _ASKED)
        fits = fits and 0 <= shapes <= header.shapes and 0 <= edges <= header.edges
        if fits and digest == _digest(base, shapes, edges):
            check_bodies(head, traits, entries, overrides, base.shapes[:shapes])
            content = bytes(reader.content[start : reader.at])
            return _Bodies(content, head, traits, entries, overrides, base)
    raise ValueError(
        "the snapshot is of another world: with another max_hits or rest_speed, or with "
        "shapes that this one never had. (A pickle holds the shapes, too.)"
    )


def _setups_for(family: Family, bodies: Sequence[_Bodies]) -> list[Setup]:
    """Return the setup of each world; those of one stepper with the same bodies share one."""
    made: dict[tuple[int, int], Setup] = {}
    unchanged: dict[tuple[int, int], bool] = {}
    setups = []
    for site, own in zip(family.sites, bodies, strict=True):
        key = (id(site.setup), id(own))
        if key not in unchanged:
            unchanged[key] = _pack_bodies(site.setup) == own.content
        if unchanged[key]:
            setups.append(site.setup)
            continue
        key = (site.part, id(own))
        if key not in made:
            made[key] = _made(own)
            made[key].users = 0  # so far
        setups.append(made[key])
    return setups


def _made(bodies: _Bodies) -> Setup:
    """Return a setup with these bodies."""
    head, room = bodies.head, bodies.base.room
    setup = bodies.base.copy()
    if head["bodies"] > room.bodies:
        setup.resize(bodies=int(head["bodies"]))
    if head["movers"] > room.movers:
        setup.resize(movers=int(head["movers"]))
    for name in _OF_HEADERS:
        setup.header[name] = head[name]
    setup.use_bodies(bodies.traits, bodies.entries, bodies.overrides)
    return setup


def _use_setups(family: Family, setups: Sequence[Setup]) -> None:
    """Let worlds use other setups, and have states that fit."""
    movers = max(family.movers_room, *(setup.room.movers for setup in setups))
    for setup in setups:
        if setup.room.movers < movers:
            setup.resize(movers=movers)
    is_larger = movers > family.movers_room
    states = setups[0].new_states(len(setups)) if is_larger else family.states
    for site, setup in zip(family.sites, setups, strict=True):
        site.halt()
        if site.setup is not setup:
            site.setup.users -= 1
            setup.users += 1
            site.setup = setup
        site.use_state(states[site.row])
    family.states = states


def _write(
    site: Site,
    clock: Any,
    kept: npt.NDArray[Any],
    pairs: npt.NDArray[np.int64],
    pending: npt.NDArray[Any],
) -> None:
    """Write what was kept of a world into its blocks."""
    for name in Clock.names or ():
        site.clock[name] = clock[name]
    for name, dtype in MOTIONS.items():
        site.setup.records(site.state, name, dtype)[:] = kept[name]
    site.unplan()
    plans = site.setup.records(site.state, "plans", Plan)
    for name in plans.dtype.names or ():
        plans[name] = 0
    site.inside = inside_block(pairs, site.heads(), FEW_PAIRS + len(pairs))
    site.pending = pending.copy()
    site.forget_check()
    site.warned = int(site.clock.capped)
