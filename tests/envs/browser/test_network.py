"""The functions of networks, which kernels compute without a library of mathematics."""

import math

import numpy as np
import pytest
from arkanoid.envs.browser.network import ACTIVATIONS, activate, exponential

FUNCTIONS = {
    "tanh": np.tanh,
    "relu": lambda x: max(x, 0.0),
    "elu": lambda x: x if x > 0.0 else math.expm1(x),
    "silu": lambda x: x / (1.0 + math.exp(-x)),
}


def test_the_exponential_function() -> None:
    for x in (-0.0, -1e-300, -1e-9, *-np.linspace(0.0, 690.0, 2001)):
        assert exponential(x) == pytest.approx(math.exp(x), rel=1e-11, abs=0.0)
    assert exponential(-1e4) == exponential(-math.inf) == 0.0


@pytest.mark.parametrize("name", ACTIVATIONS)
def test_activations(name: str) -> None:
    for x in (0.0, 1e-9, -1e-9, 50.0, -50.0, *np.linspace(-8.0, 8.0, 1001)):
        assert activate(x, ACTIVATIONS[name]) == pytest.approx(
            float(FUNCTIONS[name](x)), rel=1e-9, abs=1e-12
        )
