"""A player in a sitting: what the tests of playing by hand share."""

from collections.abc import Callable, Iterable
from typing import Any

from arkanoid.envs.batch.replays import Replay
from arkanoid.envs.play.by_hand import hand_config
from arkanoid.envs.play.controls import Key
from arkanoid.envs.play.scores import Scores
from arkanoid.envs.play.sitting import Board, Phase, Sitting
from arkanoid.envs.play.sound import Speaker, Tone
from arkanoid.envs.rules import FIELD_WIDTH

# No waiting between pictures.
FAST = 10_000.0
# Of pictures, in pixels: small ones are drawn quickly.
HEIGHT = 64


def sit_down(
    level: str | None = None, kept: list[Replay] | None = None, **keywords: Any
) -> Sitting:
    """A sitting whose games are kept in a list, with high scores that nobody keeps."""
    config, options = hand_config(level, **keywords)
    keep = [].append if kept is None else kept.append
    return Sitting(config, options, 5, keep, HEIGHT, Board(Scores(None), str), Listener())


class Listener(Speaker):
    """A speaker that notes what it would play."""

    def __init__(self) -> None:
        super().__init__()
        self.heard: list[Tone] = []

    def switch(self) -> str:
        return "SOUND ON"

    def play(self, tones: Iterable[Tone]) -> None:
        self.heard += tones


def tap(shown: Any, key: Key) -> None:
    """Press and release a key."""
    shown.press(key)
    shown.release(key)


def play_on(sitting: Sitting, ticks: int = 10**6) -> None:
    """Follow the lowest ball with the mouse for so many ticks, or until the game stops."""
    for _ in range(ticks):
        world = sitting.world
        balls = [
            (y, x)
            for x, y, state in zip(world.ball_x, world.ball_y, world.ball_state, strict=True)
            if state
        ]
        if balls:
            sitting.point(min(balls)[1])
        sitting.tick()
        if sitting.phase is not Phase.PLAYING:
            return


def lose(sitting: Sitting) -> None:
    """Keep the paddle away from the ball until the game is over."""
    while sitting.phase is Phase.PLAYING:
        sitting.point(FIELD_WIDTH if sitting.world.ball_x[0] < FIELD_WIDTH / 2 else 0.0)
        sitting.tick()


def post(kind: str, **attributes: Any) -> Callable[[], object]:
    """Return a function that posts an event to pygame."""
    import pygame

    return lambda: pygame.event.post(pygame.event.Event(getattr(pygame, kind), **attributes))
