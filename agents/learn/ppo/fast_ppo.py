"""stable-baselines3's PPO with loops for many worlds at once: the same learning in less time."""

import warnings
from typing import Any

import numpy as np
import torch
from gymnasium import spaces
from stable_baselines3 import PPO
from stable_baselines3.common.buffers import RolloutBuffer
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.policies import ActorCriticPolicy
from stable_baselines3.common.utils import explained_variance
from stable_baselines3.common.vec_env import VecEnv
from torch import Tensor

from ...adapter import GymnasiumVecEnv
from ...tensor_adapter import TensorVecEnv
from .actions import Actions, actions_of
from .on_device import DeviceLoop
from .rollouts import Minibatch, Rollout

# What is no part of a saved model.
_OF_THE_LOOPS = ("rollout", "_actions", "_has_told", "_loop", "_goes_on")
_FUSED = {"eps": 1e-5, "fused": True}
_STATISTICS = ("policy_gradient_loss", "value_loss", "entropy_loss", "clip_fraction")
# What a policy of its own kind may do otherwise.
_METHODS = (
    *("forward", "evaluate_actions", "extract_features", "predict_values", "get_distribution"),
    "_get_action_dist_from_latent",
)


class FastPPO(PPO):
    """stable-baselines3's PPO with loops for many worlds at once.

    Arguments, losses, logged values, callbacks and schedules are those of `PPO`, and `PPO.load`
    reads the file that `save` writes. It is faster because the policy alone decides while playing;
    values and probabilities of a whole rollout are computed at once; and bricks go through the
    first layer once for as long as none of them changes. It is fastest on a `GymnasiumVecEnv`.

    What differs from `PPO`:

    - Random numbers are drawn in another order, so weights differ for the same seed.
    - For flat vectors with bricks a minibatch consists of runs of up to 32 successive decisions of
      one world (the largest that divides ``n_steps`` and ``batch_size``); otherwise of single
      decisions. Its size is ``batch_size`` in both cases.
    - ``rollout_buffer`` stays empty. A callback finds a step in its ``locals`` (``infos`` are for
      reading: worlds whose episode goes on share an empty one), a rollout in ``rollout``.

    On a `TensorVecEnv` rollouts and updates stay on the device. A callback then finds the actions
    of a whole rollout in its ``locals``, and its ``on_step`` is called once for each: the update
    that follows is made before the training ends.

    Policies and spaces that it does not know are trained by the loops of stable-baselines3, and a
    warning says why.
    """

    # The latest rollout, or None; no part of a saved model.
    rollout: Rollout | None = None
    _actions: Actions | None = None
    _has_told = False
    _loop: DeviceLoop | None = None
    _goes_on = True

    def _setup_model(self) -> None:
        if self.policy_kwargs.get("optimizer_class", torch.optim.Adam) is torch.optim.Adam:
            self.policy_kwargs = {"optimizer_kwargs": dict(_FUSED), **self.policy_kwargs}
        super()._setup_model()

    def _setup_learn(self, *arguments: Any, **keywords: Any) -> tuple[int, BaseCallback]:
        """Begin a training; what ended the one before is no matter."""
        self._goes_on = True
        return super()._setup_learn(*arguments, **keywords)

    def _excluded_save_params(self) -> list[str]:
        return [*super()._excluded_save_params(), *_OF_THE_LOOPS]

    def _maybe_recommend_cpu(self, *arguments: Any, **keywords: Any) -> None:
        """Do not warn of graphics cards where the worlds are there, too."""
        if not isinstance(self.env, TensorVecEnv):
            super()._maybe_recommend_cpu(*arguments, **keywords)

    def collect_rollouts(
        self,
        env: VecEnv,
        callback: BaseCallback,
        rollout_buffer: RolloutBuffer,
        n_rollout_steps: int,
    ) -> bool:
        """Play ``n_rollout_steps`` decisions in each world; return False if a callback stops it."""
        reason = self.why_not_fast()
        if isinstance(env, TensorVecEnv):
            if reason is not None:
                raise ValueError(f"FastPPO can't train on a device: {reason}")
            return self._collect_on_device(env, callback)
        self._loop = None
        if reason is not None:
            if not self._has_told:
                warnings.warn(f"FastPPO trains as PPO does: {reason}", stacklevel=2)
            self._has_told, self.rollout = True, None
            return super().collect_rollouts(env, callback, rollout_buffer, n_rollout_steps)
        self.policy.set_training_mode(False)
        with torch.no_grad():
            return self._collect(env, callback, n_rollout_steps)

    def why_not_fast(self) -> str | None:
        """Return why the loops of stable-baselines3 are in use, or None if they are not."""
        policy = self.policy
        if self.use_sde:
            return "it knows no state-dependent exploration"
        if isinstance(self.observation_space, spaces.Dict):
            return "it knows no observations of several parts"
        if not isinstance(policy, ActorCriticPolicy) or actions_of(policy) is None:
            return f"it knows no actions in {self.action_space}"
        if self.rollout_buffer_class is not RolloutBuffer:
            return "the rollout buffer is of another class"
        own = [name for name in _METHODS if _differs(policy, name)]
        return f"the policy has a method {own[0]!r} of its own" if own else None

    def _collect(self, env: VecEnv, callback: BaseCallback, n_rollout_steps: int) -> bool:
        rollout = self._prepared(env, n_rollout_steps)
        callback.on_rollout_start()
        # Only now: the callback may begin new episodes.
        observations: Any = self._last_obs
        dones: Any = self._last_episode_starts
        rollout.begin()
        for step in range(n_rollout_steps):
            actions = rollout.act(step, observations)
            new_obs, rewards, dones, ended = self._step(env, actions)
            self.num_timesteps += env.num_envs
            infos: list[dict[str, Any]] = [{}] * env.num_envs
            for world, info in ended.items():
                infos[world] = info
            callback.update_locals(locals())
            if not callback.on_step():
                self._keep_last(new_obs, dones)
                return False
            self._update_info_buffer(list(ended.values()), np.ones(len(ended), np.bool_))
            rollout.add(step, rewards, dones, ended)
            observations = new_obs
        self._keep_last(observations, dones)
        rollout.finish(observations, self.gamma, self.gae_lambda)
        callback.update_locals(locals())
        callback.on_rollout_end()
        return True

    def _collect_on_device(self, env: TensorVecEnv, callback: BaseCallback) -> bool:
        if not self._goes_on:
            self._goes_on = True
            return False
        if self._loop is None or not self._loop.fits(self, env):
            self._actions, self._loop = actions_of(self.policy), DeviceLoop(self, env)
        loop = self._loop
        callback.on_rollout_start()
        self.policy.set_training_mode(False)
        infos = loop.collect()
        actions = loop.actions
        self.num_timesteps += self.n_steps * env.num_envs
        self._update_info_buffer(infos, np.ones(len(infos), np.bool_))
        callback.update_locals(locals())
        self._goes_on = bool(callback.on_step())
        callback.on_rollout_end()
        return True

    def settle(self) -> None:
        """Bring what lies on a device to where stable-baselines3 keeps it."""
        if self._loop is not None:
            seen: Any = self._loop.env.observe().cpu().numpy()
            self._last_obs = seen
            self._last_episode_starts = np.zeros(len(seen), np.bool_)

    def _prepared(self, env: VecEnv, steps: int) -> Rollout:
        """Return the place for a rollout, the same one as long as it fits."""
        key = (id(self.policy), id(env), steps, env.num_envs, self.batch_size)
        if self.rollout is None or self.rollout.key != key:
            actions = actions_of(self.policy)
            assert actions is not None
            self._actions = actions
            self.rollout = Rollout(self.policy, actions, env, steps, self.batch_size)
        return self.rollout

    def _step(self, env: VecEnv, actions: Tensor) -> tuple[Any, Any, Any, dict[int, Any]]:
        """Step an environment; return its arrays and the infos of worlds that have one to tell."""
        chosen = actions.cpu().numpy()
        space = self.action_space
        if isinstance(space, spaces.Box):
            # A Gaussian knows no bounds.
            chosen = np.clip(chosen.reshape(-1, *space.shape), space.low, space.high)
        if isinstance(env, GymnasiumVecEnv):
            return env.step_batch(chosen)
        observations, rewards, dones, infos = env.step(chosen)
        return observations, rewards, dones, {n: info for n, info in enumerate(infos) if info}

    def _keep_last(self, observations: Any, dones: Any) -> None:
        """Keep what the next rollout begins with; the environment may use its arrays again."""
        is_tensor = isinstance(observations, torch.Tensor)
        kept: Any = observations.clone() if is_tensor else np.array(observations)
        self._last_obs = kept
        self._last_episode_starts = np.array(dones)

    def train(self) -> None:
        """Update the networks by the latest rollout."""
        if self._loop is not None:
            self._train_on_device(self._loop)
            return
        rollout = self.rollout
        if rollout is None:
            super().train()
            return
        self.policy.set_training_mode(True)
        self._update_learning_rate(self.policy.optimizer)
        optimizer, gradients = self.policy.optimizer, _one_array(self.policy)
        statistics: list[Tensor] = []
        divergences: list[Tensor] = []
        loss = torch.zeros(())
        goes_on = True
        for epoch in range(self.n_epochs):
            divergences = []
            for batch in rollout.minibatches():
                loss, of_batch, divergence = self.loss(batch)
                statistics.append(of_batch)
                divergences.append(divergence)
                if self.target_kl is not None and divergence > 1.5 * self.target_kl:
                    goes_on = False
                    if self.verbose >= 1:
                        print(f"Early stopping at step {epoch}: max kl reached: {divergence:.2f}")
                    break
                gradients.zero_()
                loss.backward()
                # As torch's clip_grad_norm_.
                norm = torch.linalg.vector_norm(gradients)
                gradients.mul_((self.max_grad_norm / (norm + 1e-6)).clamp_(max=1))
                optimizer.step()
            self._n_updates += 1
            if not goes_on:
                break
        means = torch.stack(statistics).mean(0).tolist()
        for name, mean in zip(_STATISTICS, means, strict=True):
            self.logger.record(f"train/{name}", mean)
        self.logger.record("train/approx_kl", torch.stack(divergences).mean().item())
        self.logger.record("train/loss", loss.item())
        self._log_update(rollout.values[:-1], rollout.returns)

    def _train_on_device(self, loop: DeviceLoop) -> None:
        self.policy.set_training_mode(True)
        self._update_learning_rate(self.policy.optimizer)
        loop.begin_update()
        for name, value in loop.learn().items():
            self.logger.record(f"train/{name}", value)
        self._log_update(loop.values.cpu().numpy(), loop.returns.cpu().numpy())

    def _clips(self) -> tuple[Any, Any]:
        """Return the clip ranges of ratios and of values; the latter None if there is none."""
        if self._loop is not None:
            return self._loop.clip, self._loop.clip_of_values
        remaining = self._current_progress_remaining
        of_values = self.clip_range_vf
        clip = self.clip_range(remaining)  # type: ignore[operator]
        return clip, of_values(remaining) if of_values is not None else None  # type: ignore[operator]

    def loss(self, batch: Minibatch) -> tuple[Tensor, Tensor, Tensor]:
        """Return the loss of a minibatch, four parts of it for the log, and the divergence."""
        assert self._actions is not None
        clip, most = self._clips()
        advantages = batch.advantages
        if self.normalize_advantage and len(advantages) > 1:
            advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
        log_prob, entropy = self._actions.judge(batch.outputs, batch.actions)
        log_ratio = log_prob - batch.old_log_prob
        ratio = log_ratio.exp()
        within = ratio.clamp(1 - clip, 1 + clip)
        gain = -torch.min(advantages * ratio, advantages * within).mean()
        values = batch.values
        if self.clip_range_vf is not None:
            values = batch.old_values + (values - batch.old_values).clamp(-most, most)
        error = torch.nn.functional.mse_loss(batch.returns, values)
        loss = gain - self.ent_coef * entropy + self.vf_coef * error
        with torch.no_grad():
            divergence = (ratio - 1 - log_ratio).mean()
            clipped = ((ratio - 1).abs() > clip).float().mean()
            parts = torch.stack([gain, error, -entropy, clipped])
        return loss, parts, divergence

    def _log_update(self, values: Any, returns: Any) -> None:
        """Log what an update says besides its losses."""
        remaining = self._current_progress_remaining
        explained = explained_variance(values.flatten(), returns.flatten())
        self.logger.record("train/explained_variance", explained)
        if hasattr(self.policy, "log_std"):
            self.logger.record("train/std", self.policy.log_std.exp().mean().item())
        self.logger.record("train/n_updates", self._n_updates, exclude="tensorboard")
        self.logger.record("train/clip_range", self.clip_range(remaining))  # type: ignore[operator]
        if self.clip_range_vf is not None:
            of_values = self.clip_range_vf(remaining)  # type: ignore[operator]
            self.logger.record("train/clip_range_vf", of_values)


def _differs(policy: ActorCriticPolicy, name: str) -> bool:
    """Tell whether a policy's class replaces a method of `ActorCriticPolicy`."""
    return getattr(type(policy), name) is not getattr(ActorCriticPolicy, name)


def _one_array(policy: ActorCriticPolicy) -> Tensor:
    """Return an array [weights]; the gradients of the policy's parameters become its parts.

    So they are cleared, measured and shortened by one operation each. Frozen parameters have none:
    the optimiser would follow what is left of an earlier one.
    """
    for parameter in policy.parameters():
        parameter.grad = None
    parameters = [each for each in policy.parameters() if each.requires_grad]
    whole = torch.zeros(sum(each.numel() for each in parameters), device=policy.device)
    parts = whole.split([each.numel() for each in parameters])
    for parameter, part in zip(parameters, parts, strict=True):
        parameter.grad = part.view_as(parameter)
    return whole
