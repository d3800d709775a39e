"""PPO's rollouts and updates where the environment's tensors are, for `FastPPO`."""

import math
from collections.abc import Iterator
from typing import Any

import torch
from gymnasium import spaces
from stable_baselines3 import PPO
from torch import Tensor

from ...tensor_adapter import TensorVecEnv
from .actions import actions_of
from .observations import Whole
from .replayed import Replayed
from .rollouts import Minibatch

_RECENT = 100  # of the episodes that ended in a rollout, the latest ones are told


class DeviceLoop:
    """Plays rollouts of one length, and learns from them, without waiting for the device.

    Args:
        model: whose policy, optimiser, settings and `loss` it uses.
        env: where it plays.

    Attributes:
        env: where it plays.
        clip, clip_of_values: the ranges of the loss, as tensors that recorded work reads.
        actions: of the latest rollout, [steps, worlds, ...].
        values, returns: of the latest rollout, [steps, worlds].
    """

    def __init__(self, model: Any, env: TensorVecEnv) -> None:
        self._model, self.env = model, env
        policy, steps, worlds = model.policy, model.n_steps, env.num_envs
        self._policy = policy
        device = self._device = policy.device
        choice = actions_of(policy)
        assert choice is not None
        self._choice = choice
        space: Any = policy.action_space
        bounds = (space.low, space.high) if isinstance(space, spaces.Box) else ()
        self._bounds = [torch.as_tensor(each, device=device) for each in bounds]
        self._seen = Whole(policy, steps, worlds)

        def numbers(*shape: int, dtype: torch.dtype = torch.float32) -> Tensor:
            return torch.zeros(shape, dtype=dtype, device=device)

        self._outputs = numbers(steps, worlds, policy.action_net.out_features)
        # Not drawn here: a resumed training would draw another time.
        self._noise = torch.zeros_like(self._outputs)
        self.actions = torch.zeros_like(choice.draw(self._outputs, self._noise))
        self._rewards, self._goes_on = numbers(steps, worlds), numbers(steps, worlds)
        self._done = numbers(steps, worlds, dtype=torch.bool)
        self._ended = numbers(steps, 2 + len(env.keywords), worlds, dtype=torch.float64)
        self.values, self.returns = numbers(steps, worlds), numbers(steps, worlds)
        self._advantages, self._log_prob = numbers(steps, worlds), numbers(steps, worlds)
        self.clip, self.clip_of_values = numbers(), numbers()
        self._key = _key_of(model)
        self._batch_size = min(model.batch_size, steps * worlds)
        self._chosen = numbers(self._batch_size, dtype=torch.int64)
        self._statistics, self._latest = numbers(6), numbers(6)
        self._rate = numbers()
        self._play = Replayed(self._play_rollout, device)
        self._learns(self._learning())
        self._random = torch.Generator(device)

    def fits(self, model: Any, env: TensorVecEnv) -> bool:
        """Tell whether it can go on with a model as it is now, in an environment."""
        return self.env is env and self._key == _key_of(model)

    def collect(self) -> list[dict[str, Any]]:
        """Play a rollout; return the infos of the latest episodes that ended in it.

        Raises ValueError if the policy's outputs are not finite.
        """
        # The processor's generator is a part of checkpoints.
        self._random.manual_seed(int(torch.randint(2**62, ())))
        self._choice.renew(self._noise, self._random)
        with torch.no_grad():
            self._play()
        if not torch.isfinite(self._outputs).all():
            raise ValueError("found invalid values: the policy's outputs are not finite")
        return list(self._episodes())

    def learn(self) -> dict[str, float]:
        """Update the networks; return the means of the statistics that `PPO` logs."""
        count = self._done.numel()
        self._statistics.zero_()
        model, batches = self._model, 0
        for _ in range(model.n_epochs):
            order = torch.randperm(count, generator=self._random, device=self._device)
            self._latest.zero_()
            goes_on = True
            for chosen in order.split(self._batch_size):
                goes_on = self._learn_from(chosen)
                batches += 1
                if not goes_on:
                    break
            model._n_updates += 1
            if not goes_on:
                break
        means = (self._statistics / batches).tolist()
        in_epoch = math.ceil(count / self._batch_size)
        names = ("policy_gradient_loss", "value_loss", "entropy_loss", "clip_fraction")
        logged = dict(zip(names, means[:4], strict=True))
        return logged | {
            "approx_kl": (self._latest[4] / in_epoch).item(),
            "loss": means[5],
        }

    def _play_rollout(self) -> None:
        """Play all steps, and compute values, advantages and returns."""
        env, observations = self.env, self.env.observe()
        for step, noise in enumerate(self._noise):
            outputs = self._outputs[step]
            outputs.copy_(self._seen.act(step, observations))
            self.actions[step] = self._choice.draw(outputs, noise)
            played = env.play(self._to_play(self.actions[step]))
            observations, done = played.observations, played.terminated | played.truncated
            # A truncated episode would have gone on: its last reward includes the value of that.
            cut = played.truncated & ~played.terminated
            beyond = self._policy.predict_values(played.last).flatten()
            self._rewards[step] = played.rewards + self._model.gamma * beyond * cut
            self._goes_on[step] = ~done
            self._done[step] = done
            self._ended[step] = played.ended
        values = self._seen.values(observations)
        self._estimate(values)
        self._log_prob.copy_(self._choice.judge(self._outputs, self.actions)[0])

    def _to_play(self, actions: Tensor) -> Tensor:
        """Return actions within the bounds of their space: a Gaussian knows none."""
        return torch.clamp(actions, *self._bounds) if self._bounds else actions

    def _estimate(self, values: Tensor) -> None:
        """Compute generalised advantage estimates; ``values`` has a step more."""
        gamma, decay = self._model.gamma, self._model.gae_lambda
        latest = torch.zeros_like(values[0])
        for step in range(len(self._rewards) - 1, -1, -1):
            goes_on = self._goes_on[step]
            error = self._rewards[step] + gamma * values[step + 1] * goes_on - values[step]
            latest = error + gamma * decay * goes_on * latest
            self._advantages[step] = latest
        self.values.copy_(values[:-1])
        torch.add(self._advantages, self.values, out=self.returns)

    def _episodes(self) -> Iterator[dict[str, Any]]:
        """Yield the infos of the latest episodes that ended in the rollout."""
        steps, worlds = self._done.nonzero(as_tuple=True)
        rows = self._ended[steps[-_RECENT:], :, worlds[-_RECENT:]].tolist()
        for total, length, *others in rows:
            named = dict(zip(self.env.keywords, others, strict=True))
            yield {"episode": {"r": total, "l": int(length), "t": 0.0, **named}}

    def _learn_from(self, chosen: Tensor) -> bool:
        """Make a gradient step from decisions; return False if the policy has moved too far."""
        limit = self._model.target_kl
        if limit is None and len(chosen) == self._batch_size:
            self._chosen.copy_(chosen)
            self._learn()
            return True
        loss, statistics = self._judge(chosen)
        if limit is not None and statistics[4] > 1.5 * limit:
            return False
        self._step(loss)
        return True

    def _learn_chosen(self) -> None:
        self._step(self._judge(self._chosen)[0])

    def _judge(self, chosen: Tensor) -> tuple[Tensor, Tensor]:
        """Return the loss of decisions, and statistics, which are added to the others."""
        (network,) = self._seen.evaluated(chosen, len(chosen))
        parts = (self._log_prob, self._advantages, self.returns, self.values)
        old, advantages, returns, values = (part.flatten()[chosen] for part in parts)
        taken = self.actions.flatten(0, 1)[chosen]
        batch = Minibatch(*network, taken, old, advantages, returns, values, chosen)
        loss, of_batch, divergence = self._model.loss(batch)
        statistics = torch.cat([of_batch, divergence.view(1), loss.detach().view(1)])
        self._statistics += statistics
        self._latest += statistics
        return loss, statistics

    def _step(self, loss: Tensor) -> None:
        gradients = torch.autograd.grad(loss, self._parameters)
        for parameter, gradient in zip(self._parameters, gradients, strict=True):
            parameter.grad = gradient
        torch.nn.utils.clip_grad_norm_(self._parameters, self._model.max_grad_norm)
        (group,) = self._policy.optimizer.param_groups
        plain = group["lr"], group.get("capturable", False)
        if self._device.type == "cuda":
            # A recorded step reads the rate from memory.
            group["lr"], group["capturable"] = self._rate, True
        self._policy.optimizer.step()
        group["lr"], group["capturable"] = plain

    def _learning(self) -> list[torch.nn.Parameter]:
        """Return the policy's parameters, but those that are frozen."""
        return [each for each in self._policy.parameters() if each.requires_grad]

    def _learns(self, parameters: list[torch.nn.Parameter]) -> None:
        """Let gradient steps change these parameters, and no others."""
        self._parameters = parameters
        for parameter in self._policy.parameters():
            parameter.grad = None  # the optimiser would follow what is left of an earlier one
        # The optimiser makes its memory in its first steps.
        self._learn = Replayed(self._learn_chosen, self._device, plain_calls=3)

    def begin_update(self) -> None:
        """Bring the schedules' present values, and the parameters, to where the update takes them.

        Parameters may have been frozen, or set free, since the last one.
        """
        model: PPO = self._model
        learning = self._learning()
        if [*map(id, learning)] != [*map(id, self._parameters)]:
            self._learns(learning)
        remaining = model._current_progress_remaining
        self._rate.fill_(model.policy.optimizer.param_groups[0]["lr"])
        self.clip.fill_(model.clip_range(remaining))  # type: ignore[operator]
        if model.clip_range_vf is not None:
            self.clip_of_values.fill_(model.clip_range_vf(remaining))  # type: ignore[operator]


def _key_of(model: Any) -> tuple[int, ...]:
    """Return what the tensors of a loop depend on."""
    return id(model.policy), model.n_steps, model.batch_size
