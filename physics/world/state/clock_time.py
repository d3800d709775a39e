"""Times with twice the digits: the sum of two numbers, of which the second is small.

At a billion field widths per step, the last digit of a single number is a tenth of a width: a ball
would stop before the wall, or behind it. In a world that has run for long it is the same. (Knuth's
error-free sum, The Art of Computer Programming 2, section 4.2.2.)
"""

from ...kernels import kernel


@kernel
def later(time: float, low: float, duration: float) -> tuple[float, float]:
    """Return a time plus a duration, as a sum of two numbers."""
    total = time + duration
    part = total - time
    low += (time - (total - part)) + (duration - part)
    # The carry makes the first numbers of two times have the order of the times.
    time = total + low
    return time, low - (time - total)


@kernel
def elapsed(time: float, low: float, since: float, since_low: float) -> float:
    """Return the duration from the time ``since`` to a time."""
    return (time - since) + (low - since_low)


@kernel
def is_earlier(time: float, low: float, other: float, other_low: float) -> bool:
    """Return whether a time comes before another one."""
    return time < other or (time == other and low < other_low)
