"""Recorded games as transitions: data for imitation and offline reinforcement learning."""

from collections.abc import Iterator
from dataclasses import replace
from os import PathLike
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..actions import COMMANDS
from ..config import SEEN
from ..observe.parts import copy_of
from ..state import INFO_FIELDS
from .playback import begin_next_life, replay_states
from .replays import Replay


class Transition(NamedTuple):
    """One decision of a recorded game, as the environment's `step` tells it.

    Attributes:
        observation: what the player could see before it.
        action: what was done: an integer, or float32 [2], velocity and fire.
        reward: what it paid.
        terminated, truncated: whether the game was lost, or cut, with it.
        info: the events in it, and the state after it.
        next_observation: what could be seen after it.
    """

    observation: Any
    action: Any
    reward: float
    terminated: bool
    truncated: bool
    info: dict[str, Any]
    next_observation: Any


def replay_transitions(
    replay: Replay | str | PathLike[str], actions: str | None = None, **keywords: Any
) -> Iterator[Transition]:
    """Yield the transitions of a recorded game, which is played again.

    Args:
        replay: the game, or the path of its file.
        actions: the form of the actions, see `Config`; None is that in which the game was played.
        **keywords: how the game is seen, whatever was seen when it was recorded: ``observation``,
            ``size``, ``grey``, ``stack``, ``channels``; and with ``episodic_life=True`` each lost
            life ends an episode, as it does in an environment.

    Raises:
        OSError, ValueError, ReplayDivergedError: as `play_replay`.
        ValueError: a keyword is not one of these or illegal, or the form of actions lacks what was
            done in a decision.
    """
    game = replay if isinstance(replay, Replay) else Replay.load(replay)
    others = sorted(set(keywords) - set(SEEN))
    if others:
        raise ValueError(f"{others[0]!r} does not say how a game is seen: {', '.join(SEEN)} do")
    encoded = encode_commands(game.config.actions if actions is None else actions, game.commands)
    return _transitions(replace(game, config=replace(game.config, **keywords)), encoded)


def _transitions(game: Replay, actions: NDArray[Any]) -> Iterator[Transition]:
    states = replay_states(game)
    before = copy_of(next(states).observations[0])
    for action, batch in zip(actions, states, strict=True):
        after = copy_of(batch.observations[0])
        (outcome,) = batch.outcomes
        yield Transition(
            before,
            action,
            float(outcome["reward"]),
            bool(outcome["terminated"]),
            bool(outcome["truncated"]),
            {name: outcome[field].item() for name, field in INFO_FIELDS.items()},
            after,
        )
        # A new life's first picture fills the stack: then this is another observation.
        before = copy_of(batch.observations[0]) if begin_next_life(batch) else after


def encode_commands(actions: str, commands: NDArray[np.float64]) -> NDArray[Any]:
    """Return commands, velocity and fire [n, 2], as actions: int64 [n], or float32 [n, 2].

    Raises:
        ValueError: one of them is none of the actions.
    """
    encoded: NDArray[Any]
    if actions == "box":
        encoded = commands.astype(np.float32)
        found = (encoded == commands).all(axis=1)
    elif isinstance(actions, str) and actions in COMMANDS:
        same = (commands[:, np.newaxis] == COMMANDS[actions]).all(axis=2)
        encoded, found = same.argmax(axis=1), same.any(axis=1)
    else:
        raise ValueError(f"actions must be box or one of {', '.join(COMMANDS)}; got {actions!r}")
    if not found.all():
        decision = int(found.argmin())
        reason = "they are no float32" if actions == "box" else "use actions='box'"
        raise ValueError(
            f"{actions!r} has no action for velocity and fire {commands[decision].tolist()} of "
            f"decision {decision}: {reason}"
        )
    return encoded
