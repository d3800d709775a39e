"""The states of worlds, stepped and kept as bytes: what a single world and a batch share."""

import hashlib
import math
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arguments import not_negative, whole
from ..kernels import inner, kernel
from ..kernels.sealed import seal, unseal
from .clock_time import is_earlier
from .grid import NO_ONE, interacts
from .records import (
    CROSS_X,
    CROSS_Y,
    END,
    FREE,
    MEET,
    NOTHING,
    Block,
    Blocks,
    Flags,
    Hit,
    PlanRecord,
)
from .setup import ByteArray, Setup
from .stepping import INVALID, step_worlds
from .tournament import better
from .view import (
    WorldView,
    clock_of,
    header_of,
    heads_of,
    inside_of,
    motions_after_step_of,
    motions_of,
    moving_of,
    open_world,
    plans_of,
    traits_of,
    winners_of,
)

FIRST_ROOM = 64  # hits; it grows as needed

VERSION = 1  # of the format of snapshots
_MARK = b"ARKWORLD"
_DIGEST_SIZE = 16  # bytes

# What may be wrong in a snapshot. Kernels return its place here, for they have no words.
_PARTS = ("", "a clock", "motions", "bodies inside sensors", "plans", "an order of plans", "lists")
_CLOCK, _MOTIONS, _INSIDE, _PLANS, _WINNERS, _LISTS = range(1, 7)
_MANY = 1 << 60  # of what is counted
_LONGER_THAN_UNIT = 1.0 + 1e-6  # the square of a normal's length is less


class Stepper:
    """Steps the worlds of a matrix of states, and keeps the memory that this takes.

    Args:
        setup: what the worlds share.
        states: uint8 [worlds, bytes], changed in place.
    """

    def __init__(self, setup: Setup, states: ByteArray) -> None:
        self.workspace = setup.workspace.copy()
        self._states = states
        self._has_sensors = len(setup.sensing) > 0
        self._hits: npt.NDArray[Any] = np.zeros(0, Hit)
        self._grow(FIRST_ROOM + 2 * len(setup.sensing))

    def step(self, dt: float, steps: int) -> npt.NDArray[Any]:
        """Step all worlds; return their hits, sorted by world and time.

        Raises:
            ValueError: if a position or velocity is not finite, or has become so.
        """
        count = step_worlds(self._states, self.workspace, self._buffer, 0, dt, steps)
        while count < 0:
            if count == INVALID:
                raise ValueError(
                    "a position or velocity is not finite: it was set so, or has become too large "
                    "for a number; or the time has"
                )
            self._grow(2 * len(self._hits))
            count = step_worlds(self._states, self.workspace, self._buffer, -1 - count, dt, steps)
        if count == 0:
            return self._hits[:0]
        hits = self._hits[:count].copy()
        if self._has_sensors and (hits["kind"] == END).any():
            # That a body left a sensor is known later than it happened.
            hits = hits[np.lexsort((hits["time"], hits["world"]))]
        return hits

    def _grow(self, room: int) -> None:
        """Make room for so many hits."""
        hits = np.zeros(room, Hit)
        hits[: len(self._hits)] = self._hits
        self._hits, self._buffer = hits, hits.view(np.uint8)


def checked_step(dt: Any, steps: Any) -> tuple[float, int]:
    """Check the length of a step and the number of steps, and return them."""
    if type(dt) is float and 0.0 <= dt < math.inf and type(steps) is int and 0 < steps < 1 << 63:
        return dt, steps
    return not_negative("dt", dt), whole("steps", steps, at_least=1)


def pack_states(states: ByteArray, setup: Setup) -> bytes:
    """Return states, uint8 [worlds, bytes], and the digest of their setup, as a snapshot."""
    return seal(_MARK, VERSION, _digest(setup) + states.tobytes())


def unpack_states(snapshot: bytes, states: ByteArray, setup: Setup) -> None:
    """Write a snapshot into the states that it was taken of.

    Raises:
        TypeError: if it is not bytes.
        ValueError: if it is corrupt, of another version, or of another world or batch, or if no
            step leaves a world like that. The states do not change then.
    """
    content = unseal("snapshot of worlds", _MARK, VERSION, snapshot)
    digest, kept = content[:_DIGEST_SIZE], content[_DIGEST_SIZE:]
    if digest != _digest(setup) or len(kept) != states.nbytes:
        raise ValueError(
            "the snapshot is of another world: with other bodies, static ones elsewhere, other "
            "masks or restitutions, or another number of worlds"
        )
    restored = np.empty(states.shape, np.uint8)
    restored.reshape(-1)[:] = np.frombuffer(kept, np.uint8)
    fault = find_fault(restored, setup.workspace)
    if fault:
        index, part = divmod(fault, len(_PARTS))
        raise ValueError(f"the snapshot is corrupt: world {index} can't have such {_PARTS[part]}")
    states[:] = restored


def _digest(setup: Setup) -> bytes:
    return hashlib.sha256(setup.workspace.tobytes()).digest()[:_DIGEST_SIZE]


@kernel
def find_fault(states: Blocks, workspace: Block) -> int:
    """Return world * len(_PARTS) + part of the first fault in states; 0 if there is none.

    Stepping checks no index, and trusts that plans which hold are those that the last step left.

    Args:
        states: uint8 [worlds, bytes]; workspace: uint8 [bytes], see `records`.
    """
    for index in range(states.shape[0]):
        world = open_world(states[index], workspace)
        part = 0
        if not _is_possible_clock(world):
            part = _CLOCK
        elif not _are_finite(world):
            part = _MOTIONS
        elif not _are_flags(inside_of(world)):
            part = _INSIDE
        elif clock_of(world).planned:
            # Otherwise the next step makes all of these anew.
            if not _are_possible_plans(world):
                part = _PLANS
            elif not _are_winners(world):
                part = _WINNERS
            elif not _are_lists(world):
                part = _LISTS
        if part != 0:
            return index * len(_PARTS) + part
    return 0


@inner
def _is_possible_clock(world: WorldView) -> bool:
    """Tell whether a clock is a sum of two numbers, and its counts are possible."""
    clock = clock_of(world)
    if not (abs(clock.time) < math.inf and clock.time + clock.time_low == clock.time):
        return False
    if clock.planned not in (0, 1) or (clock.planned and not header_of(world).continuous):
        return False
    return bool(0 <= clock.capped < _MANY)


@inner
def _are_finite(world: WorldView) -> bool:
    """Tell whether all positions and velocities are finite numbers."""
    motions = motions_of(world)
    for slot in range(motions.shape[0]):
        motion = motions[slot]
        for number in (motion.x, motion.y, motion.vx, motion.vy):
            if not abs(number) < math.inf:
                return False
    return True


@inner
def _are_flags(inside: Flags) -> bool:
    """Tell whether all flags are 0 or 1."""
    others = 0
    for place in range(inside.shape[0]):
        others += inside[place] > 1
    return bool(others == 0)


@inner
def _are_possible_plans(world: WorldView) -> bool:
    """Tell whether every plan is one that a step may leave."""
    plans = plans_of(world)
    possible = True
    for slot in range(plans.shape[0]):
        possible = possible and _is_possible_plan(world, plans[slot], slot)
    return possible


@inner
def _is_possible_plan(world: WorldView, plan: PlanRecord, slot: int) -> bool:
    """Tell whether a body's plan is one that a step may leave."""
    header, clock = header_of(world), clock_of(world)
    if plan.at != clock.time or plan.at_low != clock.time_low or plan.hits != 0:
        return False
    if plan.rests != 0 or plan.instant != 0 or plan.nowhere != 0 or plan.stage != FREE:
        return False
    if plan.tied not in (0, 1) or not plan.slack >= 0.0:
        return False
    if not 0.0 <= plan.speed < math.inf:
        return False
    if plan.time + plan.time_low != plan.time or not is_earlier(
        clock.time, clock.time_low, plan.time, plan.time_low
    ):
        return False
    body = moving_of(world)[slot]
    roams = traits_of(world)[body].roams
    if not roams and not (0 <= plan.column < header.columns and 0 <= plan.row < header.rows):
        return False
    # The motion that the plan was made for; users may have changed the present one.
    motion = motions_after_step_of(world)[slot]
    if plan.kind == NOTHING:
        return bool(plan.time == math.inf)
    if plan.kind == CROSS_X:
        column = plan.column + (1 if motion.vx > 0.0 else -1)
        return bool(not roams and 0 <= column < header.columns)
    if plan.kind == CROSS_Y:
        row = plan.row + (1 if motion.vy > 0.0 else -1)
        return bool(not roams and 0 <= row < header.rows)
    if plan.kind != MEET or not 0 <= plan.partner < header.bodies or plan.partner == body:
        return False
    if not plan.normal_x * plan.normal_x + plan.normal_y * plan.normal_y < _LONGER_THAN_UNIT:
        return False
    return interacts(traits_of(world)[body], traits_of(world)[plan.partner])


@inner
def _are_winners(world: WorldView) -> bool:
    """Tell whether a tournament has the winners that its plans give."""
    winners, plans = winners_of(world), plans_of(world)
    leaves = winners.shape[0] // 2
    for slot in range(leaves):
        if winners[leaves + slot] != (slot if slot < plans.shape[0] else -1):
            return False
    for node in range(leaves - 1, 0, -1):
        if winners[node] != better(plans, winners[2 * node], winners[2 * node + 1]):
            return False
    return True


@inner
def _are_lists(world: WorldView) -> bool:
    """Tell whether every body that does not roam is once in the list of its plan's cell."""
    heads, plans = heads_of(world), plans_of(world)
    traits, moving = traits_of(world), moving_of(world)
    missing = 0
    for slot in range(plans.shape[0]):
        missing += 1 - traits[moving[slot]].roams
    if heads.shape[0] == 0:
        return True
    for cell in range(heads.shape[0]):
        previous, slot = NO_ONE, heads[cell]
        while slot != NO_ONE:
            if not 0 <= slot < plans.shape[0] or missing == 0:
                return False
            plan = plans[slot]
            own = plan.row * header_of(world).columns + plan.column
            if traits[moving[slot]].roams or own != cell or plan.previous != previous:
                return False
            missing -= 1
            previous, slot = slot, plan.next
    return bool(missing == 0)
