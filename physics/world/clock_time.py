"""Times to twice the digits: the sum of two numbers, of which the second is small.

At a billion field widths a step, the last digit of a single number is a tenth of a width: a ball
would stop short of the wall, or beyond it. And a world may be old. (Knuth's error-free sum, The Art
of Computer Programming 2, section 4.2.2.)
"""

from ..kernels import kernel


@kernel
def later(time: float, low: float, duration: float) -> tuple[float, float]:
    """Return the time that comes a duration later, as a sum of two numbers."""
    total = time + duration
    part = total - time
    low += (time - (total - part)) + (duration - part)
    # Carried over, so that the order of two times is that of their first numbers.
    time = total + low
    return time, low - (time - total)


@kernel
def elapsed(time: float, low: float, since: float, since_low: float) -> float:
    """Return how much later one time is than another."""
    return (time - since) + (low - since_low)


@kernel
def is_earlier(time: float, low: float, other: float, other_low: float) -> bool:
    """Tell which of two times comes first."""
    return time < other or (time == other and low < other_low)
