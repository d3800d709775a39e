"""Gymnasium's own player: arrows or A and D, space fires, Escape ends.

    python play_with_gymnasium.py [steps]

It stops after this number of steps. Without a display, set `SDL_VIDEODRIVER=dummy`. The game's own
player, `arkanoid play`, has pauses, the mouse and replays.
"""

import sys
from typing import Any

import gymnasium as gym
import pygame
from gymnasium.utils.play import play


class Counter:
    """Counts the score, and ends the game after some steps."""

    def __init__(self, steps: float) -> None:
        self.left = steps
        self.score = 0

    def __call__(self, *step: Any) -> None:
        """Read what `play` passes after each step; the last argument is the info."""
        self.score = step[-1].get("score", 0)
        self.left -= 1
        if self.left <= 0:
            pygame.event.post(pygame.event.Event(pygame.QUIT))


def main() -> None:
    """Play one game in a window."""
    counter = Counter(float(sys.argv[1]) if len(sys.argv) > 1 else float("inf"))
    play(gym.make("arkanoid:Arkanoid-v0", render_mode="rgb_array"), seed=0, callback=counter)
    print(f"played, {counter.score} points")


if __name__ == "__main__":
    main()
