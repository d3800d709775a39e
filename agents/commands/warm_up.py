"""`arkanoid warm-up`: compiles the kernels of the game, once and for all."""

import argparse
import time
from collections.abc import Callable
from typing import Any

import gymnasium as gym

from ..experiment.errors import SettingsError

_EPILOG = """\
The compiled code is kept on disk, so later starts do not wait. Without this command, each part is
compiled when it is first needed. Other processes may start meanwhile: they compile what they miss.

  arkanoid warm-up
  ARKANOID_CACHE_DIR=/srv/kernels arkanoid warm-up   for an image, or for several users"""

_FULL, _LITE = "arkanoid:Arkanoid-v0", "arkanoid:ArkanoidLite-v0"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments: there are none."""
    parser.epilog = _EPILOG


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Use each part once; show what is being compiled. Return the exit status.

    Raises `SettingsError` if nothing would be kept.
    """
    # Imported on demand: the help needs no package of the engine.
    from ...envs.atomic import why_no_kernels_are_kept

    reason = why_no_kernels_are_kept()
    if reason is not None:
        raise SettingsError(
            f"{reason}, so nothing would be kept; set ARKANOID_CACHE_DIR to a folder that can be "
            "written"
        )
    begun = time.perf_counter()
    for number, (part, use) in enumerate(_PARTS.items(), 1):
        print(f"{number} of {len(_PARTS)}: {part}", flush=True)
        use()
    print(f"all is compiled, after {time.perf_counter() - begun:.0f} s")
    return 0


def _use_game() -> None:
    env: Any = _begin(_FULL).unwrapped
    env.action_masks()
    env.restore(env.snapshot())
    _begin(_FULL, options={"seed": 1})


def _use_observations() -> None:
    _begin(_FULL, observation="grid")
    _begin(_FULL, landing=True)


def _use_levels() -> None:
    # Imported on demand: Numba is slow to import.
    from ...envs.levels import generate_level

    generate_level(1)


def _use_batches() -> None:
    for actions in ("discrete6", "box"):
        envs: Any = gym.make_vec(_FULL, num_envs=2, actions=actions)
        envs.reset(seed=0)
        envs.step(envs.action_space.sample())
        if actions != "box":
            envs.unwrapped.action_masks()
        envs.close()


def _use_pictures() -> None:
    from ...envs.draw.overlay import draw_overlay

    env = _begin(_FULL, render_mode="rgb_array")
    draw_overlay(env.render(), "ROUND 1", ["READY"])
    env.close()


def _use_observed_pictures() -> None:
    for grey in (False, True):
        _begin(_LITE, observation="rgb", grey=grey)


def _begin(env_id: str, options: dict[str, Any] | None = None, **keywords: Any) -> Any:
    """Return an environment after its first step."""
    env = gym.make(env_id, **keywords)
    env.reset(seed=0, options=options)
    env.step(env.action_space.sample())
    return env


# What is compiled, each with something that needs it.
_PARTS: dict[str, Callable[[], None]] = {
    "the game": _use_game,
    "observations": _use_observations,
    "generated levels": _use_levels,
    "vector environments": _use_batches,
    "pictures and windows": _use_pictures,
    "pictures as observations": _use_observed_pictures,
}
