"""What a network computes exactly, and how far float32 numbers can be from it.

A sum of n products of float32 numbers, added up in any order, is wrong by at most n u / (1 - n u)
times the sum of the products' magnitudes, where u = 2 ** -24 is the largest relative error of one
operation (Higham, *Accuracy and Stability of Numerical Algorithms*, section 3.1).
"""

from typing import NamedTuple

import torch
from arkanoid.agents.learn.landing import LandingExtractor
from arkanoid.agents.learn.networks import LatticeExtractor, PlanesExtractor
from stable_baselines3.common.policies import ActorCriticPolicy
from stable_baselines3.common.torch_layers import NatureCNN
from torch import nn
from torch.nn.functional import conv2d, linear

LAYERS = (nn.Linear, nn.Conv2d, nn.Tanh, nn.ReLU, nn.ELU, nn.SiLU)
_UNIT = 2.0**-24
# The steepest slopes, rounded up; all others of the functions here have at most 1.
_STEEPEST = {nn.SiLU: 1.1}
# A function takes some operations: 4 units of its result's last place.
_FUNCTION = 8.0 * _UNIT


class Bounded(NamedTuple):
    """Exact numbers, float64, and how far from them computed ones can be."""

    exact: torch.Tensor
    error: torch.Tensor


def judge_exactly(policy: ActorCriticPolicy, seen: torch.Tensor) -> tuple[Bounded, Bounded]:
    """Return the outputs of the actor, and the values, of observations [n, ...] as in training."""
    features = _features(policy.features_extractor, seen)
    actor = _through(policy.mlp_extractor.policy_net, features)
    critic = _through(policy.mlp_extractor.value_net, features)
    return _through(policy.action_net, actor), _through(policy.value_net, critic)


def within_layer(layer: nn.Module, numbers: torch.Tensor) -> Bounded:
    """Return what one of `LAYERS` makes of float32 numbers [n, ...]."""
    return _through(layer, _known(numbers))


def _features(extractor: nn.Module, seen: torch.Tensor) -> Bounded:
    numbers = _known(seen)
    if seen.dtype == torch.uint8:
        numbers = Bounded(numbers.exact / 255.0, _UNIT * numbers.exact / 255.0)
    if isinstance(extractor, LandingExtractor):
        # These features are compared bit for bit by another test.
        return _known(extractor(seen))
    if isinstance(extractor, LatticeExtractor):
        start, stop = extractor._start, extractor._stop
        bricks = _through(extractor.lattice, _known(seen[:, start:stop]))
        others = torch.cat((seen[:, :start], seen[:, stop:]), dim=1)
        return Bounded(
            *(torch.cat(pair, dim=1) for pair in zip(_known(others), bricks, strict=True))
        )
    if isinstance(extractor, PlanesExtractor):
        return _through(extractor.planes, numbers)
    if isinstance(extractor, NatureCNN):
        return _through(extractor.linear, _through(extractor.cnn, numbers))
    return Bounded(*(each.flatten(1) for each in numbers))


def _known(numbers: torch.Tensor) -> Bounded:
    exact = numbers.double()
    return Bounded(exact, torch.zeros_like(exact))


def _through(module: nn.Module, numbers: Bounded) -> Bounded:
    """Return what a module makes of numbers."""
    x, error = numbers
    if isinstance(module, nn.Sequential):
        for part in module:
            numbers = _through(part, numbers)
        return numbers
    if isinstance(module, nn.Linear):
        return _sums(module, lambda x, weight, bias: linear(x, weight, bias), numbers)
    if isinstance(module, nn.Conv2d):
        shape = module.stride, module.padding
        return _sums(module, lambda x, weight, bias: conv2d(x, weight, bias, *shape), numbers)
    if isinstance(module, nn.Flatten | nn.Unflatten):
        return Bounded(module(x), module(error))
    y = module(x)
    if isinstance(module, nn.ReLU):
        return Bounded(y, error)
    # It subtracts 1, whose last place is larger.
    size = y.abs() + 1.0 if isinstance(module, nn.ELU) else y.abs()
    return Bounded(y, _STEEPEST.get(type(module), 1.0) * error + _FUNCTION * size)


def _sums(module: nn.Linear | nn.Conv2d, products, numbers: Bounded) -> Bounded:  # type: ignore[no-untyped-def]
    weight, bias = module.weight.double(), module.bias.double()
    count = weight[0].numel() + 1
    part = count * _UNIT / (1.0 - count * _UNIT)
    x, error = numbers
    none = torch.zeros_like(bias)
    magnitudes = products(x.abs() + error, weight.abs(), bias.abs())
    return Bounded(
        products(x, weight, bias), products(error, weight.abs(), none) + part * magnitudes
    )
