"""Flat networks with gradients by hand, for observations that share their bricks.

Torch's own gradients take twice as long: they go through memory once per small operation, and torch
makes and adds whole arrays for each slice of the first layer's weights.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import torch
from torch import Tensor, nn

# Activations in place, and the gradients [n, units] of their arguments from those of their results.
# All need the results only.
_ACTIVATIONS: dict[type[nn.Module], tuple[Callable[[Tensor], Tensor], Callable[..., Tensor]]] = {
    nn.ReLU: (
        torch.relu_,
        lambda gradient, result: torch.ops.aten.threshold_backward(
            gradient, result, 0, grad_input=gradient
        ),
    ),
    nn.Tanh: (
        torch.tanh_,
        lambda gradient, result: torch.ops.aten.tanh_backward(
            gradient, result, grad_input=gradient
        ),
    ),
}


class Seen(NamedTuple):
    """What decisions [n] saw.

    Attributes:
        others: all numbers but the bricks, [n, others].
        bricks: of each distinct lattice, [lattices, cells].
        places: the lattice of each decision, [n], rising.
        starts: the first decision that saw each lattice, [lattices].
    """

    others: Tensor
    bricks: Tensor
    places: Tensor
    starts: Tensor


class Network:
    """Linear layers with activations between them; the first takes bricks and other numbers.

    A lattice's products with the first layer are made once, and repeated over the decisions that
    saw it; their gradient is the sum over these decisions.

    Args:
        layers: in their order, as `is_known` demands.
        bricks: their columns of the first layer's weights.
    """

    def __init__(self, layers: list[Any], bricks: slice) -> None:
        self.linears: list[nn.Linear] = layers[::2]
        self.parameters = [each for layer in self.linears for each in (layer.weight, layer.bias)]
        self.widest = max(layer.out_features for layer in self.linears)
        self._activations = [_ACTIVATIONS[type(layer)] for layer in layers[1::2]]
        self._bricks = bricks

    def first(self) -> tuple[Tensor, Tensor]:
        """Return the first layer's weights [inputs, units] of bricks and of other numbers."""
        weight, bricks = self.linears[0].weight.detach(), self._bricks
        others = torch.cat((weight[:, : bricks.start], weight[:, bricks.stop :]), 1)
        return weight[:, bricks].t(), others.t()

    def products(self, bricks: Tensor, of_bricks: Tensor) -> Tensor:
        """Return what lattices [n, cells] add to the first layer, its bias included."""
        return torch.addmm(self.linears[0].bias, bricks, of_bricks)

    def through(self, sums: Tensor) -> list[Tensor]:
        """Return each layer's values; the first layer's sums are overwritten by its values."""
        values = [sums]
        for layer, (activate, _) in zip(self.linears[1:], self._activations, strict=True):
            activate(values[-1])
            values.append(torch.addmm(layer.bias, values[-1], layer.weight.t()))
        return values

    def forward(self, seen: Seen, weights: tuple[Tensor, Tensor]) -> list[Tensor]:
        """Return each layer's values [n, units]; ``weights`` are those of `first`."""
        of_bricks, of_others = weights
        products = self.products(seen.bricks, of_bricks)
        sums = products.index_select(0, seen.places).addmm_(seen.others, of_others)
        return self.through(sums)

    def backward(
        self, seen: Seen, values: list[Tensor], gradient: Tensor, gradients: list[Tensor]
    ) -> None:
        """Add the gradients of `parameters` to ``gradients``.

        Args:
            seen: what `forward` took.
            values: what it returned.
            gradient: of the last values, [n, outputs].
            gradients: as `parameters`, but the first layer's weights have the bricks last.
        """
        for index in range(len(self.linears) - 1, 0, -1):
            gradients[2 * index].addmm_(gradient.t(), values[index - 1])
            gradients[2 * index + 1].add_(gradient.sum(0))
            gradient = gradient @ self.linears[index].weight
            self._activations[index - 1][1](gradient, values[index - 1])
        # The sums over the decisions that saw a lattice; segment_reduce is 15 times slower.
        numbers = torch.arange(len(gradient))
        sums = torch.embedding_bag(gradient, numbers, seen.starts, False, 0)[0]
        others = seen.others.shape[1]
        gradients[0][:, :others].addmm_(gradient.t(), seen.others)
        gradients[0][:, others:].addmm_(sums.t(), seen.bricks)
        gradients[1].add_(sums.sum(0))

    def in_place(self, gradients: list[Tensor]) -> list[Tensor]:
        """Return gradients with the bricks at their place."""
        bricks, stop = self._bricks, gradients[0].shape[1]
        others = stop - (bricks.stop - bricks.start)
        of_others, of_bricks = gradients[0].split((others, stop - others), 1)
        before, after = of_others[:, : bricks.start], of_others[:, bricks.start :]
        return [torch.cat((before, of_bricks, after), 1), *gradients[1:]]


class Networks(torch.autograd.Function):
    """Two networks over a minibatch, part by part: a part stays in the processor's cache."""

    @staticmethod
    def forward(
        ctx: Any, networks: list[Network], parts: list[Seen], *_parameters: Tensor
    ) -> tuple[Tensor, ...]:
        """Return each network's outputs [n, outputs].

        Args:
            ctx: torch's.
            networks: any number of them.
            parts: what the decisions of each part saw.
            _parameters: of all networks, in their order; these get gradients.
        """
        weights = [network.first() for network in networks]
        values = [
            [network.forward(seen, first) for seen in parts]
            for network, first in zip(networks, weights, strict=True)
        ]
        ctx.networks, ctx.parts, ctx.values = networks, parts, values
        return tuple(torch.cat([part[-1] for part in of_network]) for of_network in values)

    @staticmethod
    def backward(ctx: Any, *grad_outputs: Tensor) -> tuple[Tensor | None, ...]:
        """Return the gradients of all parameters."""
        found: list[Tensor | None] = [None, None]
        sizes = [len(seen.places) for seen in ctx.parts]
        for network, values, whole in zip(ctx.networks, ctx.values, grad_outputs, strict=True):
            gradients = [torch.zeros_like(each) for each in network.parameters]
            for seen, of_part, gradient in zip(ctx.parts, values, whole.split(sizes), strict=True):
                network.backward(seen, of_part, gradient, gradients)
            found += network.in_place(gradients)
        ctx.values = None
        return tuple(found)


def is_known(layers: list[nn.Module]) -> bool:
    """Tell whether layers are linear ones with known activations between them."""
    linears, others = layers[::2], layers[1::2]
    return all(type(layer) is nn.Linear and layer.bias is not None for layer in linears) and all(
        type(layer) in _ACTIVATIONS for layer in others
    )
