"""Gymnasium's own player: arrows or A and D, space fires, Escape ends.

    python play_with_gymnasium.py [steps]

After so many steps it ends by itself. Without a display: `SDL_VIDEODRIVER=dummy`. The game's own
player, with pauses, mouse and replays, is `arkanoid play`.
"""

import sys
from typing import Any

import gymnasium as gym
import pygame
from gymnasium.utils.play import play


class Counter:
    """Ends the play after some steps, and knows the score."""

    def __init__(self, steps: float) -> None:
        self.left = steps
        self.score = 0

    def __call__(self, *step: Any) -> None:
        """Take what `play` tells of a step; the info is last."""
        self.score = step[-1].get("score", 0)
        self.left -= 1
        if self.left <= 0:
            pygame.event.post(pygame.event.Event(pygame.QUIT))


def main() -> None:
    """Play."""
    counter = Counter(float(sys.argv[1]) if len(sys.argv) > 1 else float("inf"))
    play(gym.make("arkanoid:Arkanoid-v0", render_mode="rgb_array"), seed=0, callback=counter)
    print(f"played, {counter.score} points")


if __name__ == "__main__":
    main()
