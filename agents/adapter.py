"""Gymnasium's vector environments for stable-baselines3, which has an interface of its own.

`GymnasiumVecEnv` changes no number: training on it gives the same weights, bit for bit, as training
on stable-baselines3's own `DummyVecEnv` of single environments.
"""

import time
from collections.abc import Iterator, Sequence
from copy import deepcopy
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from numpy.typing import NDArray
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env.base_vec_env import (
    VecEnv,
    VecEnvIndices,
    VecEnvObs,
    VecEnvStepReturn,
)

from ..envs.checks import counted


class GymnasiumVecEnv(VecEnv):
    """A stable-baselines3 `VecEnv` over a Gymnasium `VectorEnv` in SAME_STEP mode.

    A world's info is empty until its episode ends. Then it is the episode's final info with
    ``terminal_observation``, ``TimeLimit.truncated`` (truncated and not terminated: the value of
    the last observation counts) and ``episode``. The latter has the return ``r``, the length ``l``
    in steps, the seconds ``t`` since this object was made, the values of the final info that
    ``info_keywords`` names, and the sums over all steps of those that ``summed_keywords`` names.

    Observations, rewards and infos belong to the caller, even if the environment reuses its arrays
    (``copy=False``): stable-baselines3 keeps an observation until after the next step, and adds to
    the rewards.
    """

    def __init__(
        self,
        env: VectorEnv[Any, Any, Any],
        info_keywords: Sequence[str] = (),
        summed_keywords: Sequence[str] = (),
    ) -> None:
        """Adapt ``env``.

        Raises:
            TypeError: it is a single environment.
            ValueError: it does not restart worlds in SAME_STEP mode.
        """
        _check(env)
        self.env = env
        self._info_keywords = tuple(info_keywords)
        self._sums = {key: np.zeros(env.num_envs, np.float64) for key in summed_keywords}
        self._actions: NDArray[Any] | None = None
        self._returns = np.zeros(env.num_envs, np.float64)
        self._lengths = np.zeros(env.num_envs, np.int64)
        self._start = time.perf_counter()
        super().__init__(env.num_envs, env.single_observation_space, env.single_action_space)
        # Films are as fast as the environment says: `VecVideoRecorder` looks here.
        self.metadata = dict(env.metadata)

    def reset(self) -> VecEnvObs:
        """Start an episode in every world, with the seeds and options that were set before.

        Worlds with equal options are reset together, by ``reset_mask``.
        """
        seeds = None if all(seed is None for seed in self._seeds) else list(self._seeds)
        observations: Any = None
        self.reset_infos = [{} for _ in range(self.num_envs)]
        groups = list(self._options_by_worlds())
        if len(groups) > 1:
            # Gymnasium's own environments reset a part of the worlds only after a reset of all.
            self.env.reset(seed=seeds)  # type: ignore[arg-type]
        for mask, options in groups:
            # Gymnasium types the seed as one integer, though its own environments take a list.
            observations, infos = self.env.reset(seed=seeds, options=options)  # type: ignore[arg-type]
            for world in np.flatnonzero(mask).tolist():
                self.reset_infos[world] = world_info(infos, world)
        for statistic in (self._returns, self._lengths, *self._sums.values()):
            statistic[:] = 0
        self._reset_seeds()
        self._reset_options()
        return _own(observations)

    def set_seeds(self, seeds: Sequence[int]) -> None:
        """Give each world its own seed for the next reset.

        `seed`, which stable-baselines3 calls, gives world ``i`` the seed plus ``i``: neighbouring
        seeds share almost all worlds. Raises ValueError unless there is one seed for each world.
        """
        if len(seeds) != self.num_envs:
            worlds = counted(self.num_envs, "world")
            raise ValueError(f"{counted(len(seeds), 'seed')} for {worlds}; give one for each")
        self._seeds = list(seeds)

    def step_async(self, actions: NDArray[Any]) -> None:
        """Take the actions [worlds, ...]; `step_wait` carries them out."""
        self._actions = actions

    def step_wait(self) -> VecEnvStepReturn:
        """Step all worlds; return observations, rewards (float32), dones and one info per world."""
        observations, rewards, dones, ended = self.step_batch(self._actions)
        infos: list[dict[str, Any]] = [ended.get(world, {}) for world in range(self.num_envs)]
        return _own(observations), np.array(rewards, np.float32), dones, infos

    def step_batch(self, actions: Any) -> tuple[Any, Any, NDArray[np.bool_], dict[int, Any]]:
        """Step all worlds without copies, for trainers that take whole arrays.

        Returns:
            The environment's own observations [worlds, ...] and rewards [worlds], which its next
            step may overwrite; which episodes ended, bool [worlds]; and their infos, by world.
        """
        observations, rewards, terminated, truncated, infos = self.env.step(actions)
        self._returns += rewards
        self._lengths += 1
        for key, sums in self._sums.items():
            sums += infos[key]
        dones = terminated | truncated
        ended = {}
        for world in np.flatnonzero(dones).tolist():
            was_cut = bool(truncated[world] and not terminated[world])
            ended[world] = self._final_info(infos, world, was_cut)
            self.reset_infos[world] = world_info(infos, world)
        return observations, rewards, dones, ended

    def _final_info(self, infos: dict[str, Any], world: int, was_cut: bool) -> dict[str, Any]:
        """Return the info of a world's ended episode, and begin the statistics of its next one."""
        info = world_info(infos.get("final_info", {}), world)
        info["TimeLimit.truncated"] = was_cut
        info["terminal_observation"] = deepcopy(infos["final_obs"][world])
        info["episode"] = {
            "r": float(self._returns[world]),
            "l": int(self._lengths[world]),
            "t": round(time.perf_counter() - self._start, 6),
            **{key: info[key] for key in self._info_keywords},
        }
        for key, sums in self._sums.items():
            # What the step added belongs to the world's next episode.
            info["episode"][key] = float(sums[world] - infos[key][world] + info[key])
        for statistic in (self._returns, self._lengths, *self._sums.values()):
            statistic[world] = 0
        return info

    def _options_by_worlds(self) -> Iterator[tuple[NDArray[np.bool_], dict[str, Any] | None]]:
        """Yield masks (bool [worlds]) of worlds with equal options, and the options for `reset`."""
        waiting = list(range(self.num_envs))
        while waiting:
            options = self._options[waiting[0]]
            mask = np.array([other == options for other in self._options])
            waiting = [world for world in waiting if not mask[world]]
            yield mask, (options or None) if mask.all() else {**options, "reset_mask": mask}

    def get_statistics(self) -> dict[str, Any]:
        """Return the statistics of the episodes that are being played, for `set_statistics`."""
        sums = {key: values.copy() for key, values in self._sums.items()}
        return {"returns": self._returns.copy(), "lengths": self._lengths.copy(), "sums": sums}

    def set_statistics(self, statistics: dict[str, Any]) -> None:
        """Continue from what `get_statistics` returned for the same state of the environment."""
        self._returns[:] = statistics["returns"]
        self._lengths[:] = statistics["lengths"]
        for key, values in self._sums.items():
            values[:] = statistics["sums"][key]

    def close(self) -> None:
        """Close the environment."""
        self.env.close()

    def get_images(self) -> Sequence[NDArray[np.uint8] | None]:
        """Return a picture of every world, uint8 [height, width, 3]."""
        frames = self.env.render()
        return [None] * self.num_envs if frames is None else list(frames)  # type: ignore[arg-type]

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        """Return an attribute of each world: the single environment's, or the native batch's."""
        worlds = list(self._get_indices(indices))
        get_each = getattr(self.env.unwrapped, "get_attr", None)
        if get_each is not None:
            values = get_each(attr_name)
            return [values[world] for world in worlds]
        return [getattr(self.env.unwrapped, attr_name)] * len(worlds)

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        """Set an attribute of every world. Raises ValueError for a part of the worlds."""
        self._demand_all(indices, f"set {attr_name!r}")
        set_each = getattr(self.env.unwrapped, "set_attr", None)
        if set_each is not None:
            set_each(attr_name, value)
        else:
            setattr(self.env.unwrapped, attr_name, value)

    def env_method(
        self,
        method_name: str,
        *method_args: Any,
        indices: VecEnvIndices = None,
        **method_kwargs: Any,
    ) -> list[Any]:
        """Call a method of every world, and return one result per world.

        A native batch is called once. If it returns a list, tuple or array with one item per world,
        each world gets its item; otherwise all get the same. Raises ValueError for a part of the
        worlds.
        """
        self._demand_all(indices, f"call {method_name!r}")
        call_each = getattr(self.env.unwrapped, "call", None)
        if call_each is not None:
            return list(call_each(method_name, *method_args, **method_kwargs))
        result = getattr(self.env.unwrapped, method_name)(*method_args, **method_kwargs)
        if isinstance(result, list | tuple | np.ndarray) and len(result) == self.num_envs:
            return list(result)
        return [result] * self.num_envs

    def env_is_wrapped(
        self, wrapper_class: type[gym.Wrapper[Any, Any, Any, Any]], indices: VecEnvIndices = None
    ) -> list[bool]:
        """Tell for each world whether a wrapper of this class is around it.

        True for stable-baselines3's `Monitor`, because this adapter keeps the same statistics.
        """
        worlds = list(self._get_indices(indices))
        if issubclass(wrapper_class, Monitor):
            return [True] * len(worlds)
        singles = getattr(self.env.unwrapped, "envs", None)
        if singles is None:
            return [False] * len(worlds)
        return [_is_wrapped(singles[world], wrapper_class) for world in worlds]

    def _demand_all(self, indices: VecEnvIndices, action: str) -> None:
        if len(set(self._get_indices(indices))) != self.num_envs:
            raise ValueError(f"cannot {action} for some worlds only: they share one environment")


def _check(env: Any) -> None:
    """Refuse what is no vector environment in SAME_STEP mode, and say how to make one."""
    if not isinstance(env, VectorEnv):
        raise TypeError(
            f"GymnasiumVecEnv takes a Gymnasium vector environment, and {env} is none: make it by "
            "gym.make_vec(id, num_envs, autoreset_mode='SameStep'), or give stable-baselines3 the "
            "single environment as it is"
        )
    mode = env.metadata.get("autoreset_mode")
    if mode != AutoresetMode.SAME_STEP:
        raise ValueError(
            "stable-baselines3 needs worlds that restart in the step that ends their episode; this "
            f"environment's autoreset_mode is {mode}: make it by "
            "gym.make_vec(id, num_envs, autoreset_mode='SameStep'), with vectorization_mode='sync' "
            "or 'async' by vector_kwargs={'autoreset_mode': 'SameStep'}"
        )


def world_info(infos: dict[str, Any], world: int) -> dict[str, Any]:
    """Return one world's info from a vector environment's infos, masked by ``_key``."""
    info: dict[str, Any] = {}
    for key, value in infos.items():
        mask = infos.get(f"_{key}")
        if mask is None or not mask[world] or key in ("final_obs", "final_info"):
            continue
        if isinstance(value, dict):
            info[key] = world_info(value, world)
        else:
            # Numbers need no deepcopy, which is several times slower.
            is_plain = isinstance(value, np.ndarray) and not value.dtype.hasobject
            info[key] = value[world].copy() if is_plain else deepcopy(value[world])
    return info


def _own(observations: VecEnvObs) -> VecEnvObs:
    """Return a copy of observations."""
    # An array's own copy is several times faster than deepcopy's.
    return observations.copy() if isinstance(observations, np.ndarray) else deepcopy(observations)


def _is_wrapped(env: gym.Env[Any, Any] | gym.Wrapper[Any, Any, Any, Any], wrapper: type) -> bool:
    while isinstance(env, gym.Wrapper):
        if isinstance(env, wrapper):
            return True
        env = env.env
    return False
