"""Vector arithmetic whose rounding does not spoil what is computed from it."""

import math

from ..kernels import kernel

# 2**27 + 1: multiplying by it splits a double into two halves of 26 bits (Veltkamp 1968).
_SPLITTER = 134217729.0


@kernel
def unit_vector(x: float, y: float) -> tuple[float, float, float]:
    """Return the unit vector along (x, y) and its length; (1, 0) and 0 for the null vector."""
    scale = max(abs(x), abs(y))
    if scale == 0.0:
        return 1.0, 0.0, 0.0
    # Scaled first: squares of lengths below 1e-154 would underflow, and spoil the unit length.
    x /= scale
    y /= scale
    length = math.sqrt(x * x + y * y)
    return x / length, y / length, scale * length


@kernel
def product_error(a: float, b: float, product: float) -> float:
    """Return a b - product exactly, for product the rounded a * b (Dekker 1971)."""
    scaled_a = _SPLITTER * a
    high_a = scaled_a - (scaled_a - a)
    low_a = a - high_a
    scaled_b = _SPLITTER * b
    high_b = scaled_b - (scaled_b - b)
    low_b = b - high_b
    return ((high_a * high_b - product) + high_a * low_b + low_a * high_b) + low_a * low_b


@kernel
def accurate_cross(ax: float, ay: float, bx: float, by: float) -> float:
    """Return ax by - ay bx to the last digits, however nearly parallel a and b are (Kahan)."""
    first = ax * by
    second = ay * bx
    return (first - second) + (product_error(ax, by, first) - product_error(ay, bx, second))


@kernel
def squared_excess(x: float, y: float, radius: float) -> float:
    """Return x^2 + y^2 - radius^2 as if with twice the digits (Ogita, Rump, Oishi 2005)."""
    square_x = x * x
    square_y = y * y
    square_r = radius * radius
    total = square_x + square_y
    part = total - square_x
    total_error = (square_x - (total - part)) + (square_y - part)
    excess = total - square_r
    part = excess - total
    excess_error = (total - (excess - part)) - (square_r + part)
    products = product_error(x, x, square_x) + product_error(y, y, square_y)
    return excess + (
        total_error + excess_error + (products - product_error(radius, radius, square_r))
    )
