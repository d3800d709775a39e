"""How fast the bodies of a group move on: one system of inequalities, one answer.

Every touch gets an impulse that pushes its bodies apart, or none. After all of them no two bodies
recede more slowly than they have to, and only where they recede exactly so fast there is an
impulse. Let x be the changes of the relative speeds that each impulse makes at its own touch, A x
those that all of them make together, and b what is lacking without them. Then

    x >= 0,  A x >= b,  x . (A x - b) = 0.

Weighted with the masses, A is symmetric and positive semidefinite. So x makes x . A x / 2 - b . x
least, and there is only one answer for the velocities, whatever the order of the touches.

The method is MPRGP (Z. Dostal, Optimal Quadratic Programming Algorithms, Springer 2009): conjugate
gradients for the touches that have an impulse, until one would pull; and a step along the others'
slopes where these are steeper. For n touches it takes about n steps, or more where light bodies
bear heavy ones. Slopes are in units of the group's speed, and weights of the largest one, so that
no square overflows or vanishes.
"""

import math

from ...kernels import kernel
from ...tolerances import NO_BEND, RESOLVED, STEPS, SWEEPS
from ..state.progress import TouchRecord
from ..state.view import WorldView, members_of, progress_of, touches_of


@kernel
def resolve(world: WorldView, tolerance: float, steps_per_touch: int, steps_of_all: int) -> bool:
    """Find the velocities of all members; return False if there are none, or it takes too long.

    If there are none, because there is no room for the bodies, each touch in turn gets what it
    lacks, a few times: so the bodies go where most of what presses them goes.

    Args:
        world: the world.
        tolerance: what a touch may lack, a fraction of the group's speed.
        steps_per_touch: after so many steps for each touch, and a few, it takes too long.
        steps_of_all: if this is more, after so many of all touches together.
    """
    touches = progress_of(world).touches
    if _bounce_each(world):
        return True
    speed = group_speed(world)
    if speed == 0.0:
        return True
    longest = _longest_step(world)
    _weigh(world)
    is_new = True
    for _ in range(STEPS + max(steps_per_touch * touches, steps_of_all // touches)):
        most, free, bound = _measure(world, speed)
        if most * speed <= tolerance * group_speed(world):
            return True
        if bound > free:
            # Steeper where there is no impulse yet.
            _set_course(world, False)
            step = _step_length(world)
            if step == math.inf:
                _settle(world)
                return False
            _advance(world, step * speed)
            is_new = True
            continue
        if is_new:
            _set_course(world, True)
        else:
            _turn(world)
        step, allowed = _step_length(world), _allowed_step(world) / speed
        if step == math.inf and allowed == math.inf:
            _settle(world)
            return False
        _advance(world, min(step, allowed) * speed)
        is_new = step > allowed
        if is_new:
            _measure(world, speed)
            _set_course(world, True)
            _project(world, longest * speed)
    return False


@kernel
def _bounce_each(world: WorldView) -> bool:
    """Let each touch that lacks something bounce as if it were alone; return whether that is all.

    It is if the touches are in different directions, or of different bodies: then they bounce as
    `bounce_velocities` says, to the bit. If not, or if some have an impulse, nothing changes.
    """
    touches = progress_of(world).touches
    for index in range(touches):
        if touches_of(world)[index].change != 0.0:
            return False
    for index in range(touches):
        touch = touches_of(world)[index]
        if touches == 1 or lacking(world, touch) > 0.0:
            _change(world, touch, (touch.restitution + 1.0) * _along(world, touch, 0.0))
    if touches == 1:
        return True
    least = RESOLVED * group_speed(world)
    for index in range(touches):
        touch = touches_of(world)[index]
        more = lacking(world, touch)
        if more > least or (touch.change != 0.0 and more < -least) or touch.change < 0.0:
            _begin_again(world)
            return False
    return True


@kernel
def group_speed(world: WorldView) -> float:
    """Return the largest of the members' old speeds, |vx| + |vy|, of the changes and the aims."""
    speed = 0.0
    for index in range(progress_of(world).members):
        member = members_of(world)[index]
        speed = max(speed, abs(member.old_vx) + abs(member.old_vy))
    for index in range(progress_of(world).touches):
        speed = max(speed, touches_of(world)[index].change, touches_of(world)[index].aim)
    return speed


@kernel
def lacking(world: WorldView, touch: TouchRecord) -> float:
    """Return by how much two bodies recede more slowly than they have to."""
    return _along(world, touch, touch.aim)


@kernel
def _along(world: WorldView, touch: TouchRecord, more: float) -> float:
    """Return the speed at which two bodies approach along their normal, and some more."""
    one = members_of(world)[touch.one]
    x, y = one.vx, one.vy
    if touch.other >= 0:
        other = members_of(world)[touch.other]
        x, y = x - other.vx, y - other.vy
    square = touch.normal_x * touch.normal_x + touch.normal_y * touch.normal_y
    return float((x * touch.normal_x + y * touch.normal_y + more) / square)


@kernel
def inverse_masses(world: WorldView, touch: TouchRecord) -> float:
    """Return the sum of the inverse masses of the two bodies of a touch."""
    total = members_of(world)[touch.one].inverse_mass
    if touch.other >= 0:
        total += members_of(world)[touch.other].inverse_mass
    return float(total)


@kernel
def _weigh(world: WorldView) -> None:
    """Let the heaviest touch weigh 1: only the ratios count, and no square may overflow."""
    least = math.inf
    for index in range(progress_of(world).touches):
        least = min(least, inverse_masses(world, touches_of(world)[index]))
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        touch.weight = least / inverse_masses(world, touch)


@kernel
def _longest_step(world: WorldView) -> float:
    """Return how far one may go along the slopes without going up again."""
    members = members_of(world)
    for index in range(progress_of(world).members):
        members[index].met = 0
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        members[touch.one].met += 1
        if touch.other >= 0:
            members[touch.other].met += 1
    # A bound of the largest eigenvalue: every body adds at most its share for each of its touches.
    largest = 1.0
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        stiffness = touch.share_a * members[touch.one].met
        if touch.other >= 0:
            stiffness += touch.share_b * members[touch.other].met
        largest = max(largest, stiffness)
    return 1.9 / largest


@kernel
def _measure(world: WorldView, speed: float) -> tuple[float, float, float]:
    """Find the slopes, in units of a speed; return (most, free, bound).

    Most is what a touch lacks, or has too much of, at most. The others are the squared lengths of
    the slopes down which one may go: of the touches that have an impulse, and of those without.
    """
    most, free, bound = 0.0, 0.0, 0.0
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        slope = -lacking(world, touch) / speed
        touch.slope = slope
        if touch.change > 0.0:
            free += slope * slope * touch.weight
            most = max(most, abs(slope))
        elif slope < 0.0:
            bound += slope * slope * touch.weight
            most = max(most, -slope)
    return most, free, bound


@kernel
def _set_course(world: WorldView, is_free: bool) -> None:
    """Let the course be the slopes of the touches that have an impulse, or of those without."""
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        if touch.change > 0.0:
            touch.course = touch.slope if is_free else 0.0
        else:
            touch.course = 0.0 if is_free else min(touch.slope, 0.0)


@kernel
def _turn(world: WorldView) -> None:
    """Let the course be the slopes of the touches that have an impulse, conjugate to the last."""
    along, square = 0.0, 0.0
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        square += touch.course * touch.bend * touch.weight
        if touch.change > 0.0:
            along += touch.slope * touch.bend * touch.weight
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        slope = touch.slope if touch.change > 0.0 else 0.0
        touch.course = slope - along / square * touch.course


@kernel
def _find_turns(world: WorldView) -> None:
    """Find how the velocities change along the course."""
    members = members_of(world)
    for index in range(progress_of(world).members):
        members[index].turn_x = members[index].turn_y = 0.0
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        if touch.course == 0.0:
            continue
        one = members[touch.one]
        one.turn_x += touch.course * touch.share_a * touch.normal_x
        one.turn_y += touch.course * touch.share_a * touch.normal_y
        if touch.other >= 0:
            other = members[touch.other]
            other.turn_x -= touch.course * touch.share_b * touch.normal_x
            other.turn_y -= touch.course * touch.share_b * touch.normal_y


@kernel
def _step_length(world: WorldView) -> float:
    """Return how far along the course it goes down; inf if it always does."""
    _find_turns(world)
    members = members_of(world)
    along, square, bend = 0.0, 0.0, 0.0
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        one = members[touch.one]
        x, y = one.turn_x, one.turn_y
        if touch.other >= 0:
            other = members[touch.other]
            x, y = x - other.turn_x, y - other.turn_y
        touch.bend = x * touch.normal_x + y * touch.normal_y
        along += touch.slope * touch.course * touch.weight
        square += touch.course * touch.course * touch.weight
        bend += touch.course * touch.bend * touch.weight
    return math.inf if bend <= NO_BEND * square else along / bend


@kernel
def _allowed_step(world: WorldView) -> float:
    """Return how far one may go until an impulse would pull."""
    step = math.inf
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        if touch.course > 0.0:
            step = min(step, touch.change / touch.course)
    return step


@kernel
def _advance(world: WorldView, step: float) -> None:
    """Go down along the course."""
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        touch.change = max(0.0, touch.change - step * touch.course)
    for index in range(progress_of(world).members):
        member = members_of(world)[index]
        member.vx += step * member.turn_x
        member.vy += step * member.turn_y


@kernel
def _project(world: WorldView, step: float) -> None:
    """Go down along the course, each touch as far as its impulse does not pull."""
    for index in range(progress_of(world).touches):
        touch = touches_of(world)[index]
        # What is cut off at 0 is no part of the course.
        touch.course = min(touch.course, touch.change / step)
    _find_turns(world)
    _advance(world, step)


@kernel
def _settle(world: WorldView) -> None:
    """Begin again, and let each touch in turn have what it lacks, a few times."""
    _begin_again(world)
    for _ in range(SWEEPS):
        for index in range(progress_of(world).touches):
            touch = touches_of(world)[index]
            _change(world, touch, max(lacking(world, touch), -touch.change))


@kernel
def _begin_again(world: WorldView) -> None:
    """Give all members their old velocities, and no touch an impulse."""
    for index in range(progress_of(world).members):
        member = members_of(world)[index]
        member.vx, member.vy = member.old_vx, member.old_vy
    for index in range(progress_of(world).touches):
        touches_of(world)[index].change = 0.0


@kernel
def _change(world: WorldView, touch: TouchRecord, step: float) -> None:
    """Change the relative speed of two bodies along their normal, each by its share."""
    touch.change += step
    one = members_of(world)[touch.one]
    one.vx -= step * touch.share_a * touch.normal_x
    one.vy -= step * touch.share_a * touch.normal_y
    if touch.other >= 0:
        other = members_of(world)[touch.other]
        other.vx += step * touch.share_b * touch.normal_x
        other.vy += step * touch.share_b * touch.normal_y
