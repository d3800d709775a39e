"""A player that looks ahead with the game itself, and so foresees exactly what happens.

It is not an agent but an upper bound to compare agents with: it knows the whole state, random
numbers included, and tries plans out in copies of the world.
"""

from typing import Any

import numpy as np
from gymnasium.vector import VectorEnv
from numpy.typing import NDArray

from ...envs import ArkanoidVectorEnv
from ...envs.rules import FIELD_HEIGHT, FIELD_WIDTH, PADDLE_TOP
from ..experiment.worlds import native
from .landing import next_ball
from .policy import encode_actions, paddle_reach

# Where on the paddle the next ball may land, in half widths from its middle: one plan for each.
OFFSETS = np.linspace(-0.9, 0.9, 13)
# How many decisions the planner looks ahead, and how many it plays at most before it looks again.
# A ball is away from the paddle for about 30.
HORIZON = 80
PLAYED = 24
# A life is worth more than anything that can be gained within the horizon.
PRICE_OF_A_LIFE = 10.0
# Later gains count a little less: of two plans that gain the same, the faster one wins.
DISCOUNT = 0.995


class Planner:
    """Plays in each of ``worlds`` the best of a few plans; it tries all of them in copies.

    A plan catches the next ball at a certain place of the paddle, and later ones at its middle.
    ``worlds`` must be native and have the observation ``vector``.
    """

    def __init__(self, worlds: VectorEnv[Any, Any, Any], seed: int = 0) -> None:
        self._worlds = native(worlds)
        self._reach = paddle_reach(worlds)
        self._scouts = ArkanoidVectorEnv(
            len(OFFSETS), autoreset_mode="SameStep", copy=False, **self._worlds.config.plain()
        )
        self._plans: dict[int, list[Any]] = {}
        self._random = np.random.default_rng(seed)

    def __call__(self, observations: NDArray[Any], worlds: NDArray[np.int64]) -> NDArray[Any]:
        """Return the next actions of the plans; make a new plan where one is used up."""
        actions = []
        for world in worlds.tolist():
            if not self._plans.get(world):
                # The first action last, because actions are taken from the end.
                self._plans[world] = self._plan(world)[::-1]
            actions.append(self._plans[world].pop())
        return np.array(actions)

    def _plan(self, world: int) -> list[Any]:
        """Return the first actions of the best plan for a world."""
        scouts = self._scouts
        observations, _ = scouts.spread(self._worlds.snapshot(world))
        count = len(OFFSETS)
        values = np.zeros(count)
        # Scouts that still play, and scouts whose next ball has not landed yet.
        playing, waiting = np.ones(count, np.bool_), np.ones(count, np.bool_)
        landed = np.full(count, PLAYED)
        taken = []
        for decision in range(HORIZON):
            # Bricks and enemies in the way are ignored; playing the plan tells what they change.
            falling = next_ball(observations, scouts.layout)[1]
            offsets = np.where(waiting, OFFSETS, 0.0)
            taken.append(self._act(observations, offsets))
            observations, rewards, terminated, truncated, infos = scouts.step(taken[-1])
            over = terminated | truncated
            lost = np.where(over, terminated, infos["lives_lost"])
            gain = (rewards - PRICE_OF_A_LIFE * lost) * DISCOUNT**decision
            values += np.where(playing, gain, 0.0)
            playing &= ~over
            rises = falling & ~next_ball(observations, scouts.layout)[1]
            low = self._heights(observations).min(axis=1) < PADDLE_TOP + 2.0
            lands = waiting & rises & low
            landed[lands] = np.minimum(landed[lands], decision + 1)
            waiting &= ~lands
        # Of equal plans one is drawn, so that the game cannot repeat itself for ever.
        best = self._random.choice(np.flatnonzero(values >= values.max() - 1e-12))
        return [actions[best] for actions in taken[: landed[best]]]

    def _act(self, observations: NDArray[Any], offsets: NDArray[Any]) -> NDArray[Any]:
        """Return the actions that bring the paddle's places ``offsets`` to where balls land."""
        target, _ = next_ball(observations, self._scouts.layout)
        paddle = observations[:, self._scouts.layout["paddle"]]
        middle = (paddle[:, 0] + 1.0) * (FIELD_WIDTH / 2)
        half = paddle[:, 1] * (FIELD_WIDTH / 2)
        moves = (target - offsets * half - middle) / self._reach
        return encode_actions(self._scouts.single_action_space, moves, fire=True)

    def _heights(self, observations: NDArray[Any]) -> NDArray[Any]:
        """Return the balls' heights; a missing ball gets the field's height."""
        layout = self._scouts.layout
        there = observations[:, layout["ball_in_play"]] > 0
        heights = (observations[:, layout["ball_y"]] + 1.0) * (FIELD_HEIGHT / 2)
        return np.where(there, heights, FIELD_HEIGHT)
