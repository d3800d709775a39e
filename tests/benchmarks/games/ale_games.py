"""Breakout of the Arcade Learning Environment: Atari's program in an emulator."""

import ale_py
import cv2
import gymnasium as gym
from gymnasium.wrappers import AtariPreprocessing

from . import Many, One

gym.register_envs(ale_py)
ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)
NAME = "ALE/Breakout-v5"


def one() -> One:
    """Return one world: grey pictures of 84 × 84, frame skip 4, the maximum of two frames."""
    cv2.setNumThreads(1)
    return One(AtariPreprocessing(gym.make(NAME, frameskip=1), frame_skip=4, screen_size=84))


def many(worlds: int, stack: int) -> Many:
    """Return the native vector environment: the same pictures, made in C++, in one thread."""
    return Many(gym.make_vec(NAME, worlds, "vector_entry_point", num_threads=1, stack_num=stack))
