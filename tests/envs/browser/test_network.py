"""The functions of networks, which kernels compute without a library of mathematics."""

import math

import numpy as np
import pytest
from arkanoid.envs.browser import operations
from arkanoid.envs.browser.operations import exponential, function_of, remainder

FUNCTIONS = {
    "TANH": np.tanh,
    "RELU": lambda x: max(x, 0.0),
    "ELU": lambda x: x if x > 0.0 else math.expm1(x),
    "SILU": lambda x: x / (1.0 + math.exp(-x)),
    "ABSOLUTE": abs,
}
PAIRS = {
    "ADD": lambda x, y: x + y,
    "SUBTRACT": lambda x, y: x - y,
    "MULTIPLY": lambda x, y: x * y,
    "DIVIDE": lambda x, y: x / y,
    "REMAINDER": np.remainder,
    "LESS": lambda x, y: float(x < y),
    "SMALLER": min,
    "LARGER": max,
}


def test_the_exponential_function() -> None:
    for x in (-0.0, -1e-300, -1e-9, *-np.linspace(0.0, 690.0, 2001)):
        assert exponential(x) == pytest.approx(math.exp(x), rel=1e-11, abs=0.0)
    assert exponential(-1e4) == exponential(-math.inf) == 0.0


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_of_one_number(name: str) -> None:
    for x in (0.0, 1e-9, -1e-9, 50.0, -50.0, *np.linspace(-8.0, 8.0, 1001)):
        assert function_of(getattr(operations, name), x, 0.0, 0.0) == pytest.approx(
            float(FUNCTIONS[name](x)), rel=1e-9, abs=1e-12
        )


@pytest.mark.parametrize("name", PAIRS)
def test_functions_of_two_numbers(name: str) -> None:
    """Rounded to float32, they have the bits of NumPy's float32 numbers."""
    luck = np.random.default_rng(2)
    xs = (luck.standard_normal(2000) * 10.0 ** luck.uniform(-3.0, 9.0, 2000)).astype(np.float32)
    ys = luck.uniform(0.1, 30.0, 2000).astype(np.float32)
    for x, y in zip(xs, ys, strict=True):
        found = np.float32(function_of(getattr(operations, name), float(x), float(y), 0.0))
        assert found == np.float32(PAIRS[name](x, y)), (x, y)


def test_a_remainder_of_large_numbers_is_exact() -> None:
    luck = np.random.default_rng(3)
    for _ in range(2000):
        x = float(np.float32(luck.uniform(1.0, 2.0) * 2.0 ** luck.integers(0, 55)))
        y = float(np.float32(luck.uniform(1.0, 30.0)))
        assert remainder(x, y) == math.fmod(x, y)
        # Python rounds only once, as torch does.
        assert remainder(-x, y) == -x % y


def test_a_choice() -> None:
    assert function_of(operations.CHOOSE, 1.0, 2.0, 3.0) == 2.0
    assert function_of(operations.CHOOSE, 0.0, 2.0, 3.0) == 3.0
