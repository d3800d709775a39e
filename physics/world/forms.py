"""The two forms of a world: lists that are edited, and blocks of bytes that kernels step."""

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from ..body import Body, FloatArray
from ..errors import InseparableError
from ..shapes.colliders import Collider
from .lookup.inside import inside_blocks, pairs_inside
from .records import Clock, Course, Motion
from .setup import BodySpec, ByteArray, build_setup, inseparable_pair, with_query
from .states import Stepper

MOST_TABLES = 16  # of shapes that queries ask about, kept for the next query


@dataclass
class Scene:
    """A world as it is edited.

    Attributes:
        is_continuous: with times of impact, not by the lecture's procedure.
        max_hits: of one body in one step.
        specs: one per body.
        motions: x, y, vx, vy, one per body.
        overrides: the restitution of single pairs, a < b.
        inside: pairs of a sensor and a body inside it.
        time: as a sum of two numbers, see `clock_time`.
        capped: how often a body has used up its hits of a step, or had no room.
    """

    is_continuous: bool
    max_hits: int
    specs: list[BodySpec] = field(default_factory=list)
    motions: list[list[float]] = field(default_factory=list)
    overrides: dict[tuple[int, int], float] = field(default_factory=dict)
    inside: set[tuple[int, int]] = field(default_factory=set)
    time: tuple[float, float] = (0.0, 0.0)
    capped: int = 0

    def remove(self, index: int) -> None:
        """Remove a body. The indices of later ones go down by one."""
        del self.specs[index]
        del self.motions[index]

        def renumbered(pairs: Iterable[tuple[int, int]]) -> Iterable[tuple[int, int]]:
            return ((a - (a > index), b - (b > index)) for a, b in pairs)

        kept = {pair: e for pair, e in self.overrides.items() if index not in pair}
        self.overrides = dict(zip(renumbered(kept), kept.values(), strict=True))
        self.inside = set(renumbered(pair for pair in self.inside if index not in pair))

    def body(self, index: int, motions: FloatArray) -> Body:
        """Return a body. Its motion is taken from ``motions``, float64 [n, 4]."""
        spec = self.specs[index]
        x, y, vx, vy = motions[index].tolist()
        return Body(spec.collider, (x, y), (vx, vy), spec.mass, spec.restitution)

    def all_motions(self) -> FloatArray:
        """Return x, y, vx, vy of all bodies, float64 [n, 4], a copy."""
        return np.array(self.motions, np.float64).reshape(-1, 4)


class Built:
    """A world as kernels step it, made from a scene.

    Attributes:
        setup: what does not change.
        states: uint8 [1, bytes], what changes.
        motions: float64 [movers, 4], a view of the states: x, y, vx, vy of the moving bodies.
        clock: `Clock` [1], a view of the states.
        stepper: steps the states.
        warned: how often a body had used up its hits when the user was last warned of it.

    Raises:
        InseparableError: if two bodies have to bounce and no finite translation separates them.
    """

    def __init__(self, scene: Scene) -> None:
        self._first_motions = scene.all_motions()
        self.setup = build_setup(
            scene.specs,
            self._first_motions[:, :2],
            self._first_motions[:, 2:],
            scene.overrides,
            scene.max_hits,
            scene.is_continuous,
        )
        pair = inseparable_pair(self.setup)
        if pair is not None:
            raise InseparableError(*(scene.body(index, self._first_motions) for index in pair))
        self.states: ByteArray = self.setup.new_state(1)
        self.motions: FloatArray = self.setup.motion_view(self.states)[0]
        self.motions[:] = self._first_motions[self.setup.moving]
        shown = self.motions.view(Motion)[:, 0]
        self.setup.records(self.states, "shown_after_step", Motion)[0] = shown
        courses = self.setup.records(self.states, "motions", Course)[0]
        for name in shown.dtype.names or ():
            courses[name] = shown[name]
        courses["at"], courses["at_low"] = scene.time
        courses["speed"] = np.abs(self.motions[:, 2:]).sum(axis=1)
        courses["fresh"] = 1
        self.clock = self.states[0, : Clock.itemsize].view(Clock)
        self.clock["time"], self.clock["time_low"] = scene.time
        self.clock["capped"] = scene.capped
        self.clock["fresh"] = 1
        self.warned = scene.capped
        self._tables: dict[Collider, tuple[ByteArray, ByteArray]] = {}
        pairs = np.array(sorted((body, sensor) for sensor, body in scene.inside), np.int64)
        blocks = inside_blocks(
            [pairs.reshape(-1, 2)[:, ::-1]], len(scene.specs), len(self.setup.sensing) > 0
        )
        self.stepper = Stepper(self.setup, self.states, blocks)

    def tables_with(self, shape: Collider) -> tuple[ByteArray, ByteArray]:
        """Return (shapes, edges) of the world with one more shape at the end, uint8 [bytes]."""
        if shape not in self._tables:
            if len(self._tables) == MOST_TABLES:
                self._tables.clear()
            shapes, edges = with_query(self.setup, shape)
            self._tables[shape] = shapes.view(np.uint8), edges.view(np.uint8)
        return self._tables[shape]

    @property
    def capped(self) -> int:
        """How often a body has used up its hits of a step."""
        return int(self.clock["capped"][0])

    def all_motions(self) -> FloatArray:
        """Return x, y, vx, vy of all bodies, float64 [n, 4], a copy."""
        motions = self._first_motions.copy()
        motions[self.setup.moving] = self.motions
        return motions

    def write_back(self, scene: Scene) -> None:
        """Write into the scene what stepping has changed."""
        scene.motions = self.all_motions().tolist()
        (pairs,) = pairs_inside(self.stepper.insides)
        scene.inside = {(sensor, body) for sensor, body in pairs.tolist()}
        scene.time = (float(self.clock["time"][0]), float(self.clock["time_low"][0]))
        scene.capped = self.capped
