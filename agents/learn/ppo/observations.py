"""The observations of a rollout, and what the networks make of them.

Two classes do the same: `Whole` takes any network; `Lattices` takes flat features of a vector with
bricks, and multiplies a lattice by the first layer once, for as long as no brick changes.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple, Protocol

import numpy as np
import torch
from gymnasium import spaces
from numpy.typing import NDArray
from stable_baselines3.common.policies import ActorCriticPolicy, BaseModel
from stable_baselines3.common.torch_layers import FlattenExtractor, MlpExtractor
from stable_baselines3.common.vec_env import VecEnv, VecEnvWrapper
from torch import Tensor, nn

# Decisions of one world that stay together in a minibatch. Each such run needs the products of at
# least one lattice; a lattice lasts about a dozen decisions.
_LONGEST_RUN = 32
_SHORTEST_RUN = 8
# Numbers that are evaluated at once, so that they stay in the processor's cache: of observations,
# and of a layer.
_AT_ONCE = 2**20
_OF_A_LAYER = 2**17


class Observations(Protocol):
    """Those of ``steps`` decisions in each world, and the ones after the last decision.

    Attributes:
        run: decisions of a world that stay together in minibatches, for `arranged`.
    """

    run: int

    def act(self, step: int, observations: Any) -> Tensor:
        """Keep a step's observations [worlds, ...]; return the policy's outputs."""
        ...

    def values(self, last: Any) -> Tensor:
        """Return the values [steps + 1, worlds] of all and of the ``last`` observations."""
        ...

    def arranged(self, numbers: Tensor) -> Tensor:
        """Return numbers [steps, worlds, ...] as the runs of minibatches, [runs, run, ...]."""
        ...

    def evaluated(self, order: Tensor, runs: int) -> Iterator[tuple[Tensor, Tensor]]:
        """Yield outputs and values [n] of minibatches of so many runs, in an order of all runs."""
        ...


class Whole:
    """Observations of any form, kept as they are, for any network."""

    run = 1

    def __init__(self, policy: ActorCriticPolicy, steps: int, worlds: int) -> None:
        self._policy = policy
        space = policy.observation_space
        dtype = torch.as_tensor(np.zeros(0, space.dtype)).dtype
        shape = space.shape or ()
        self._kept = torch.empty((steps, worlds, *shape), dtype=dtype, device=policy.device)
        self._values = torch.empty((steps + 1, worlds), device=policy.device)
        # Features that cost something are made once, for the policy and the values.
        parameters = policy.features_extractor.parameters()
        self._at_once = policy.share_features_extractor and next(parameters, None) is not None

    def act(self, step: int, observations: Any) -> Tensor:
        """Keep a step's observations; return the policy's outputs."""
        policy, kept = self._policy, self._kept[step]
        kept.copy_(torch.as_tensor(observations))
        if self._at_once:
            latent, of_values = policy.mlp_extractor(policy.extract_features(kept))
            self._values[step] = policy.value_net(of_values).flatten()
        else:
            features = BaseModel.extract_features(policy, kept, policy.pi_features_extractor)
            latent = policy.mlp_extractor.forward_actor(features)
        outputs: Tensor = policy.action_net(latent)
        return outputs

    def values(self, last: Any) -> Tensor:
        """Return the values of all and of the last observations."""
        predict = self._policy.predict_values
        steps, worlds, *shape = self._kept.shape
        if not self._at_once:
            at_once = max(1, _AT_ONCE // (worlds * math.prod(shape)))
            for step in range(0, steps, at_once):
                part = self._kept[step : step + at_once]
                values = predict(part.flatten(0, 1)).view(-1, worlds)
                self._values[step : step + len(part)] = values
        self._values[steps] = predict(torch.as_tensor(last, device=self._kept.device)).flatten()
        return self._values

    def arranged(self, numbers: Tensor) -> Tensor:
        """Return numbers as the runs of minibatches."""
        return numbers.flatten(0, 1).unsqueeze(1)

    def evaluated(self, order: Tensor, runs: int) -> Iterator[tuple[Tensor, Tensor]]:
        """Yield outputs and values of minibatches."""
        policy, flat = self._policy, self._kept.flatten(0, 1)
        for chosen in order.split(runs):
            features = policy.extract_features(flat[chosen])
            if policy.share_features_extractor:
                latent, of_values = policy.mlp_extractor(features)
            else:
                latent = policy.mlp_extractor.forward_actor(features[0])
                of_values = policy.mlp_extractor.forward_critic(features[1])
            yield policy.action_net(latent), policy.value_net(of_values).flatten()


class Lattices:
    """Vectors with bricks, for networks of which the first layer takes them as they are.

    All numbers but the bricks' are kept for each decision. The bricks' are kept once per distinct
    lattice, in ``table``; ``rows`` says which one a decision saw.
    """

    def __init__(
        self, policy: ActorCriticPolicy, steps: int, worlds: int, bricks: slice, run: int
    ) -> None:
        self.run = run
        self._bricks = bricks
        self._steps, self._worlds = steps, worlds
        self._extra = getattr(policy.features_extractor, "extra", None)
        self._actor: list[Any] = [*policy.mlp_extractor.policy_net, policy.action_net]
        self._critic: list[Any] = [*policy.mlp_extractor.value_net, policy.value_net]
        others = policy.features_dim - (bricks.stop - bricks.start)
        self._others = torch.empty(steps + 1, worlds, others)
        self._rows = np.empty((steps + 1, worlds), np.int64)
        self._first = np.empty((steps, worlds), np.bool_)
        self._seen = np.empty((worlds, bricks.stop - bricks.start), np.float32)
        self._table: list[NDArray[np.float32]] = []
        self._size = 0
        self._products = torch.empty(worlds, self._actor[0].out_features)

    def act(self, step: int, observations: Any) -> Tensor:
        """Keep a step's observations; return the policy's outputs."""
        if step == 0:
            self._table.clear()
            self._size = 0
            self._weights = _split(self._actor[0].weight, self._bricks)
        new = self._keep(step, observations)
        of_bricks, of_others = self._weights
        if new.size:
            products = torch.addmm(
                self._actor[0].bias, torch.from_numpy(self._table[-1]), of_bricks.t()
            )
            self._products[torch.from_numpy(new)] = products
        hidden = torch.addmm(self._products, self._others[step], of_others.t())
        return _through(self._actor[1:], hidden)

    def _keep(self, step: int, observations: Any) -> NDArray[np.int64]:
        """Keep a step's observations; return the worlds [n] whose bricks have changed."""
        bricks, others = self._bricks, self._others[step].numpy()
        length = observations.shape[1]
        others[:, : bricks.start] = observations[:, : bricks.start]
        others[:, bricks.start : length - self._seen.shape[1]] = observations[:, bricks.stop :]
        if self._extra is not None:
            extra = self._extra(torch.as_tensor(observations))
            others[:, length - self._seen.shape[1] :] = extra.numpy()
        lattices = observations[:, bricks]
        changed = (lattices != self._seen).any(1)
        if step == 0:
            changed[:] = True
        new = np.flatnonzero(changed)
        rows = self._rows[step]
        if step:
            rows[:] = self._rows[step - 1]
        if new.size:
            fresh = lattices[new]
            self._seen[new] = fresh
            self._table.append(fresh)
            rows[new] = np.arange(self._size, self._size + new.size)
            self._size += new.size
        if step < self._steps:
            # The first decision of a run begins a new row there, whatever came before.
            self._first[step] = changed if step % self.run else True
        return new

    def values(self, last: Any) -> Tensor:
        """Return the values of all and of the last observations."""
        self._keep(self._steps, last)
        self._lattices = torch.from_numpy(np.concatenate(self._table))
        first = self._critic[0]
        of_bricks, of_others = _split(first.weight, self._bricks)
        products = torch.addmm(first.bias, self._lattices, of_bricks.t())
        rows, others = torch.from_numpy(self._rows).flatten(), self._others.flatten(0, 1)
        parts = []
        at_once = max(1, _OF_A_LAYER // first.out_features)
        for part, numbers in zip(rows.split(at_once), others.split(at_once), strict=True):
            hidden = products.index_select(0, part).addmm_(numbers, of_others.t())
            parts.append(_through(self._critic[1:], hidden))
        self._arrange()
        return torch.cat(parts).view(self._steps + 1, self._worlds)

    def _arrange(self) -> None:
        """Bring what the minibatches take into the order of runs."""
        self._others_of_runs = self.arranged(self._others[: self._steps])
        self._first_of_runs = self.arranged(torch.from_numpy(self._first))
        self._rows_of_runs = self.arranged(torch.from_numpy(self._rows[: self._steps]))

    def arranged(self, numbers: Tensor) -> Tensor:
        """Return numbers as the runs of minibatches."""
        shape = (-1, self.run, *numbers.shape[2:])
        return numbers.transpose(0, 1).reshape(shape)

    def evaluated(self, order: Tensor, runs: int) -> Iterator[tuple[Tensor, Tensor]]:
        """Yield outputs and values of minibatches."""
        networks = [(layers[0], *_rest(layers)) for layers in (self._actor, self._critic)]
        for chosen in order.split(runs):
            others = self._others_of_runs.index_select(0, chosen).flatten(0, 1)
            first = self._first_of_runs.index_select(0, chosen).flatten()
            starts = first.nonzero().flatten()
            rows = self._rows_of_runs.index_select(0, chosen).flatten().index_select(0, starts)
            seen = LatticesSeen(
                self._lattices.index_select(0, rows), first.cumsum(0) - 1, starts, self._bricks
            )
            outputs, values = (
                _through(rest, FirstLayer.apply(layer.weight, layer.bias, seen, others, rectify))  # type: ignore[no-untyped-call]
                for layer, rectify, rest in networks
            )
            yield outputs, values.flatten()


class LatticesSeen(NamedTuple):
    """The distinct lattices of a minibatch's decisions [n].

    Attributes:
        bricks: of each lattice, [lattices, cells].
        places: the lattice of each decision, [n], rising.
        starts: the first decision that saw each lattice, [lattices].
        columns: the bricks' columns of the first layer's weights.
    """

    bricks: Tensor
    places: Tensor
    starts: Tensor
    columns: slice


class FirstLayer(torch.autograd.Function):
    """A linear layer, with a rectifier if asked for, of lattices and of other numbers.

    A lattice's products are made once, and repeated over the decisions that saw it. Their gradient
    is the sum over these decisions. By hand, because torch would make and add whole arrays for
    each slice of the weights.
    """

    @staticmethod
    def forward(
        ctx: Any,
        weight: Tensor,
        bias: Tensor,
        seen: LatticesSeen,
        others: Tensor,
        rectify: bool,
    ) -> Tensor:
        """Return the layer's values [n, units].

        Args:
            ctx: torch's.
            weight: [units, inputs].
            bias: [units].
            seen: the decisions' lattices.
            others: the decisions' other numbers, [n, inputs - cells]; they get no gradient.
            rectify: whether a rectifier follows.
        """
        of_bricks, of_others = _split(weight, seen.columns)
        products = torch.addmm(bias, seen.bricks, of_bricks.t())
        hidden = products.index_select(0, seen.places).addmm_(others, of_others.t())
        ctx.seen, ctx.rectify = seen, rectify
        if rectify:
            hidden.relu_()
        ctx.save_for_backward(others, hidden if rectify else None)
        ctx.shape = weight.shape
        return hidden

    @staticmethod
    def backward(ctx: Any, *grad_outputs: Tensor) -> tuple[Tensor, Tensor, None, None, None]:
        """Return the gradients of ``weight`` and ``bias``."""
        others, hidden = ctx.saved_tensors
        (gradient,) = grad_outputs
        seen: LatticesSeen = ctx.seen
        if ctx.rectify:
            gradient = torch.ops.aten.threshold_backward(gradient, hidden, 0)
        # The sums over the decisions that saw a lattice; segment_reduce is 15 times slower.
        numbers = torch.arange(len(gradient))
        sums = torch.embedding_bag(gradient, numbers, seen.starts, False, 0)[0]
        of_others = gradient.t() @ others
        of_weight = gradient.new_empty(ctx.shape)
        start, stop = seen.columns.start, seen.columns.stop
        of_weight[:, :start] = of_others[:, :start]
        of_weight[:, start:stop] = sums.t() @ seen.bricks
        of_weight[:, stop:] = of_others[:, start:]
        return of_weight, sums.sum(0), None, None, None


def _rest(layers: list[nn.Module]) -> tuple[bool, list[nn.Module]]:
    """Return whether a rectifier follows the first layer, and the layers after both."""
    rectify = len(layers) > 1 and type(layers[1]) is nn.ReLU
    return rectify, layers[2 if rectify else 1 :]


def _through(layers: list[nn.Module], numbers: Tensor) -> Tensor:
    """Return what layers make of numbers, which they may overwrite after the first."""
    for index, layer in enumerate(layers):
        # A layer before has made these numbers, and it does not need them again.
        in_place = index and type(layer) is nn.ReLU
        numbers = torch.relu_(numbers) if in_place else layer(numbers)
    return numbers


def _split(weight: Tensor, bricks: slice) -> tuple[Tensor, Tensor]:
    """Return the bricks' columns of a first layer's weights, and all others."""
    parts = (weight[:, : bricks.start], weight[:, bricks.stop :])
    others = parts[0] if parts[1].shape[1] == 0 else torch.cat(parts, 1)
    return weight[:, bricks], others


def observations_for(
    policy: ActorCriticPolicy, env: VecEnv, steps: int, batch_size: int
) -> Observations:
    """Return what suits a policy and an environment."""
    bricks = _bricks(policy, env)
    common = math.gcd(steps, batch_size)
    run = max(length for length in range(1, _LONGEST_RUN + 1) if common % length == 0)
    if bricks is None or run < _SHORTEST_RUN:
        return Whole(policy, steps, env.num_envs)
    return Lattices(policy, steps, env.num_envs, bricks, run)


def _bricks(policy: ActorCriticPolicy, env: VecEnv) -> slice | None:
    """Return the bricks' place in the observations, if the policy's first layer takes them."""
    space, extractor, net = (
        policy.observation_space,
        policy.features_extractor,
        policy.mlp_extractor,
    )
    is_flat = type(extractor) is FlattenExtractor or hasattr(extractor, "extra")
    is_vector = isinstance(space, spaces.Box) and space.shape is not None and len(space.shape) == 1
    # A wrapper can change observations, and on a graphics card one large product is the fastest.
    if (
        not is_flat
        or not is_vector
        or isinstance(env, VecEnvWrapper)
        or policy.device.type != "cpu"
    ):
        return None
    if space.dtype != np.float32 or not policy.share_features_extractor:
        return None
    first = [[*net.policy_net, policy.action_net][0], [*net.value_net, policy.value_net][0]]
    if type(net) is not MlpExtractor or not all(type(layer) is nn.Linear for layer in first):
        return None
    layout = env.get_attr("layout", 0)[0] if env.has_attr("layout") else None
    return layout.get("bricks") if isinstance(layout, Mapping) else None
