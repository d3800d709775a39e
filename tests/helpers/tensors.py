"""Compares environments of tensors with those of arrays."""

from typing import Any

import gymnasium as gym
import numpy as np
import torch
from numpy.typing import NDArray

# Capsules, lost lives and ends of episodes are frequent.
LIVELY = {"capsule_rate": 1.0, "lives": 1, "max_decisions": 25}


def make(device: str | None, count: int, game: str = "Arkanoid-v0", **keywords: Any) -> Any:
    """Return a vector environment of tensors on a device, or of arrays if there is none."""
    if device is not None:
        keywords["device"] = device
    return gym.make_vec(
        f"arkanoid:{game}", num_envs=count, vectorization_mode="vector_entry_point", **keywords
    )


def same(found: Any, expected: Any, where: str = "") -> None:
    """Check that tensors have the dtypes, shapes and bits of arrays; dictionaries of them, too."""
    if isinstance(expected, dict):
        assert set(found) == set(expected), where
        for key in expected:
            same(found[key], expected[key], f"{where}/{key}")
        return
    assert isinstance(found, torch.Tensor), where
    array = found.cpu().numpy()
    assert (array.dtype, array.shape) == (expected.dtype, expected.shape), where
    assert array.tobytes() == np.ascontiguousarray(expected).tobytes(), where


def same_step(found: tuple[Any, ...], expected: tuple[Any, ...]) -> None:
    """Check that two steps gave the same; of last observations, those of ended episodes."""
    for place in range(4):
        same(found[place], expected[place], str(place))
    infos, others = dict(found[4]), dict(expected[4])
    finals = {
        key: (infos.pop(key, None), others.pop(key, None)) for key in list(infos) if "final" in key
    }
    same(infos, others)
    if finals.get("_final_obs", (None, None))[1] is not None:
        for key in ("_final_obs", "_final_info", "final_info"):
            same(*finals[key], key)
        for world in np.flatnonzero(finals["_final_obs"][1]):
            seen, expected_one = finals["final_obs"][0], finals["final_obs"][1][world]
            if isinstance(seen, dict):
                same({kind: part[world] for kind, part in seen.items()}, expected_one)
            else:
                same(seen[world], expected_one)


def draw_actions(env: Any, random: np.random.Generator) -> NDArray[Any]:
    """Return random actions of all worlds."""
    space = env.single_action_space
    if isinstance(space, gym.spaces.Discrete):
        return random.integers(0, space.n, env.num_envs)
    return random.uniform(-1.0, 1.0, (env.num_envs, 2)).astype(np.float32)
