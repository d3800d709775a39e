"""What the single and the vector environment share: action space, metadata, spec and checks."""

import sys
from collections.abc import Mapping, Sequence
from copy import copy
from difflib import get_close_matches
from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.error import ResetNeeded

from .actions import COMMANDS
from .checks import check_boolean, check_integer
from .config import MAX_SIZE, Config, plain
from .levels.starts import START_OPTIONS
from .rules import TICKS_PER_SECOND
from .state import Worlds

RENDER_MODES = ("rgb_array", "human")
METADATA: dict[str, Any] = {
    "render_modes": list(RENDER_MODES),
    # At the default frame skip of 4; an instance has its own, see `instance_metadata`.
    "render_fps": TICKS_PER_SECOND // 4,
}


def action_space(config: Config) -> spaces.Space[Any]:
    """Return the space of one action."""
    if config.actions in COMMANDS:
        return spaces.Discrete(len(COMMANDS[config.actions]))
    # Whether Box is generic depends on Gymnasium's version.
    space: Any = spaces.Box(-1.0, 1.0, (2,), np.float32)
    return space  # type: ignore[no-any-return]


def instance_metadata(config: Config) -> dict[str, Any]:
    """Return an environment's metadata; frames per second follow from its frame skip."""
    return METADATA | {"render_fps": max(1, TICKS_PER_SECOND // config.frame_skip)}


class SpecWithLimit:
    """The attribute `spec` of an environment, which `gym.make` sets.

    Its ``max_episode_steps`` is the environment's own limit, for wrappers that ask for one
    (`TimeAwareObservation`). `gym.make` adds a `TimeLimit` only if the registered spec has a limit,
    and ours have none. Its keywords are such that JSON holds them.
    """

    def __get__(self, env: Any, owner: type | None = None) -> Any:
        return None if env is None else env.__dict__.get("_spec")

    def __set__(self, env: Any, spec: Any) -> None:
        if spec is not None:
            spec = copy(spec)
            spec.max_episode_steps = env.config.max_decisions
            spec.kwargs = {name: plain(value) for name, value in spec.kwargs.items()}
        env.__dict__["_spec"] = spec


def frame_size(render_size: Any) -> tuple[int, ...]:
    """Return the height, or height and width, of rendered frames; () for the default.

    Raises:
        TypeError, ValueError: it is no size.
    """
    if render_size is None:
        return ()
    sizes = (render_size,) if isinstance(render_size, int | np.integer) else render_size
    message = f"render_size must be None, a height or (height, width); got {render_size!r}"
    if isinstance(sizes, str) or not isinstance(sizes, Sequence):
        raise TypeError(message)
    if sizes is render_size and len(sizes) != 2:
        raise ValueError(message)
    for size in sizes:
        check_integer("render_size", size, 1, MAX_SIZE)
    return tuple(map(int, sizes))


def check_render_mode(render_mode: str | None, legal: tuple[str, ...]) -> None:
    """Raise a ValueError if a render mode is unknown."""
    if render_mode is not None and render_mode not in legal:
        raise ValueError(f"render_mode must be None or one of {legal}; got {render_mode!r}")


def check_was_reset(worlds: Worlds, call: str) -> None:
    """Raise a ResetNeeded if a world was never reset, before a call that shows it."""
    never = np.flatnonzero(worlds["round_number"] == 0)[:8].tolist()
    if never:
        which = f": worlds {never} had none" if len(worlds) > 1 else ""
        raise ResetNeeded(f"call reset() before the first {call}{which}")


def check_attribute(name: str, value: Any, render_modes: tuple[str, ...]) -> None:
    """Check that an attribute of a vector environment may be set to a value.

    Raises:
        AttributeError: the environment would not be what it says any more.
        TypeError, ValueError: the value is illegal.
    """
    if name == "render_mode":
        check_render_mode(value, render_modes)
    elif name == "copy":
        check_boolean("copy", value)
    else:
        raise AttributeError(
            f"{name!r} of a vector environment can't be set: 'render_mode' and 'copy' can, and "
            "names that it does not have"
        )


def check_limit(max_episode_steps: int | None, config: Config) -> None:
    """Check that a limit does not truncate earlier than the configuration's own.

    Raises:
        TypeError: it is no integer.
        ValueError: it does.
    """
    if max_episode_steps is None:
        return
    check_integer("max_episode_steps", max_episode_steps, 1, sys.maxsize)
    if max_episode_steps < config.max_decisions:
        raise ValueError(
            f"max_episode_steps={max_episode_steps} is for Gymnasium's own TimeLimit around single "
            f"environments: here use max_decisions={max_episode_steps}"
        )


def check_options(options: Any, *others: str) -> None:
    """Check that the options of a reset are known.

    Args:
        options: of the reset; None: there are none.
        others: legal ones besides `START_OPTIONS`.

    Raises:
        TypeError: they are no dictionary.
        ValueError: one is unknown.
    """
    if options is None:
        return
    if not isinstance(options, Mapping):
        raise TypeError(f"options must be None or a dictionary; got {options!r}")
    known = (*START_OPTIONS, *others)
    unknown = sorted(map(str, set(options) - set(known)))
    if unknown == ["reset_mask"]:
        raise ValueError(
            "options['reset_mask'] is for vector environments; a single one has one game to reset"
        )
    if unknown:
        near = get_close_matches(unknown[0], known, 1)
        hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known)}"
        raise ValueError(f"unknown reset option {unknown[0]!r}; {hint}")
