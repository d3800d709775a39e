"""A clip of a policy at play, drawn without a display."""

from pathlib import Path
from typing import Any

import imageio.v3 as imageio
import numpy as np
from numpy.typing import NDArray

from .baselines import Policy
from .settings import Experiment
from .worlds import make_worlds


def record_clip(experiment: Experiment, policy: Policy, path: Path) -> None:
    """Write a GIF of the first evaluation episode, at most ``evaluation.clip_seconds`` of it."""
    frames, rate = play_frames(experiment, policy)
    # A GIF counts hundredths of a second: rounding the times, not the durations, keeps its pace.
    times = np.round(np.arange(len(frames) + 1) * 100 / rate)
    durations = (np.diff(times) * 10).astype(int).tolist()
    imageio.imwrite(path, frames, duration=durations, loop=0)


def play_frames(experiment: Experiment, policy: Policy) -> tuple[NDArray[np.uint8], float]:
    """Return pictures [frames, height, width, 3] of one episode, one a decision, and their rate.

    The rate is in frames a second of game time; the clip ends with the episode or after
    ``evaluation.clip_seconds``.
    """
    worlds = make_worlds(experiment, 1, render_mode="rgb_array")
    rate = float(worlds.metadata["render_fps"])
    try:
        observations, _ = worlds.reset(seed=experiment.evaluation.seed)
        frames = [_frame(worlds)]
        while len(frames) < experiment.evaluation.clip_seconds * rate:
            observations, _, terminated, truncated, _ = worlds.step(policy(observations))
            if terminated[0] or truncated[0]:
                break
            frames.append(_frame(worlds))
    finally:
        worlds.close()
    return np.stack(frames), rate


def _frame(worlds: Any) -> NDArray[np.uint8]:
    return np.array(worlds.render()[0], np.uint8)
