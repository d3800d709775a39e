"""The tensor environment for stable-baselines3's trainers that know tensors, such as `FastPPO`."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import torch
from torch import Tensor

from ..envs.tensor_vector_env import ArkanoidTensorVectorEnv
from .adapter import GymnasiumVecEnv


class TensorStep(NamedTuple):
    """What a step of all worlds gave; the environment uses its tensors again.

    Attributes:
        observations: [worlds, ...].
        rewards: float64 [worlds].
        terminated, truncated: bool [worlds].
        last: the last observations of the episodes that ended, [worlds, ...].
        ended: the return, the length, and what the infos tell of episodes that ended, float64
            [2 + keywords, worlds].
    """

    observations: Tensor
    rewards: Tensor
    terminated: Tensor
    truncated: Tensor
    last: Tensor
    ended: Tensor


class TensorVecEnv(GymnasiumVecEnv):
    """A stable-baselines3 `VecEnv` over an `ArkanoidTensorVectorEnv` in SAME_STEP mode.

    `play` steps with tensors, and never waits for the device; a CUDA graph can hold it. What
    stable-baselines3 itself calls has NumPy's arrays, as in `GymnasiumVecEnv`.

    Args:
        env: the environment, with one kind of observation.
        info_keywords, summed_keywords: see `GymnasiumVecEnv`.
    """

    def __init__(
        self,
        env: Any,
        info_keywords: Sequence[str] = (),
        summed_keywords: Sequence[str] = (),
    ) -> None:
        super().__init__(env, info_keywords, summed_keywords)
        native: ArkanoidTensorVectorEnv = env.unwrapped
        self.device = native.device
        self._summed_keywords = tuple(summed_keywords)
        # The return, the length and the sums of the episodes that are being played.
        shape = (2 + len(self._summed_keywords), env.num_envs)
        self._running = torch.zeros(shape, dtype=torch.float64, device=self.device)

    @property
    def keywords(self) -> tuple[str, ...]:
        """The names of the rows of `TensorStep.ended`, after return and length."""
        return self._info_keywords + self._summed_keywords

    def reset(self) -> Any:
        """Begin an episode in every world; return observations, an array."""
        seeds = None if all(seed is None for seed in self._seeds) else list(self._seeds)
        observations: Any = None
        groups = list(self._options_by_worlds())
        if len(groups) > 1:
            self.env.reset(seed=seeds)  # type: ignore[arg-type]
        for _, options in groups:
            observations, _ = self.env.reset(seed=seeds, options=options)  # type: ignore[arg-type]
        self.reset_infos = [{} for _ in range(self.num_envs)]
        self._running.zero_()
        self._reset_seeds()
        self._reset_options()
        return _as_arrays(observations)

    def observe(self) -> Tensor:
        """Return the latest observations, on the device."""
        native: ArkanoidTensorVectorEnv = self.env.unwrapped  # type: ignore[assignment]
        observations: Tensor = native.observe()
        return observations

    def play(self, actions: Tensor) -> TensorStep:
        """Step all worlds with actions on the device."""
        observations, rewards, terminated, truncated, infos = self.env.step(actions)
        done, final = terminated | truncated, infos["final_info"]
        steps = [rewards, torch.ones_like(rewards)]
        steps += [torch.where(done, final[key], infos[key]) for key in self._summed_keywords]
        self._running += torch.stack([step.to(torch.float64) for step in steps])
        kept = [final[key].to(torch.float64) for key in self._info_keywords]
        sums = self._running
        ended = torch.stack([sums[0], sums[1], *kept, *sums[2:]])
        self._running *= ~done
        last: Any = infos["final_obs"]
        return TensorStep(observations, rewards, terminated, truncated, last, ended)

    def step_wait(self) -> Any:
        """Refuse: loops with arrays take the other environment."""
        raise NotImplementedError(
            "games on a device are for trainers with tensors: make the environment without "
            "device=... for this one"
        )

    def get_statistics(self) -> dict[str, Any]:
        """Return the statistics of the episodes that are being played, for `set_statistics`."""
        returns, lengths, *sums = self._running.cpu().numpy().copy()
        named = dict(zip(self._summed_keywords, sums, strict=True))
        return {"returns": returns, "lengths": lengths.astype(np.int64), "sums": named}

    def set_statistics(self, statistics: dict[str, Any]) -> None:
        """Continue from what `get_statistics` returned for the same state of the environment."""
        sums = [statistics["sums"][key] for key in self._summed_keywords]
        rows = [statistics["returns"], statistics["lengths"], *sums]
        self._running.copy_(torch.as_tensor(np.stack(rows)))


def _as_arrays(observations: Any) -> Any:
    """Return observations as arrays of NumPy."""
    if isinstance(observations, dict):
        return {name: _as_arrays(each) for name, each in observations.items()}
    return observations.cpu().numpy()
