"""Monte Carlo search: try many futures of the present state, and make the first move of the best.

The futures are the worlds of a vector environment, and all start from a snapshot of the game. Each
plays its own random plan. Their random numbers are not those of the game, so the search does not
cheat.
"""

from pathlib import Path

import numpy as np
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv

LEVEL = Path(__file__).with_name("small_level.txt")
RULES = {"levels": str(LEVEL), "actions": "discrete3", "lives": 1, "life_penalty": 1.0}
FUTURES = 256
MOVES = 12  # moves in a plan: left, right or nothing
DECISIONS = 4  # decisions per move
DISCOUNT = 0.99  # per decision: what comes later counts less


def best_move(game: ArkanoidEnv, futures: ArkanoidVectorEnv, luck: np.random.Generator) -> int:
    """Return the first move of the plan with the highest discounted reward."""
    plans = luck.integers(0, 3, (MOVES, FUTURES))
    futures.spread(game.snapshot(), seed=int(luck.integers(1 << 62)))
    worth = np.zeros(FUTURES)
    playing = np.ones(FUTURES, bool)
    for decision, actions in enumerate(plans.repeat(DECISIONS, axis=0)):
        _, rewards, terminated, truncated, _ = futures.step(actions)
        worth += rewards * playing * DISCOUNT**decision
        playing &= ~(terminated | truncated)
    return int(plans[0, worth.argmax()])


def main() -> None:
    """Play with this search until the level is cleared or the ball is lost."""
    game, futures = ArkanoidEnv(**RULES), ArkanoidVectorEnv(FUTURES, **RULES)
    luck = np.random.default_rng(0)
    _, info = game.reset(seed=0)
    bricks, decisions, terminated = info["bricks_left"], 0, False
    while info["round"] == 1 and not terminated:
        move = best_move(game, futures, luck)
        for _ in range(DECISIONS):
            _, _, terminated, _, info = game.step(move)
            decisions += 1
            if info["bricks_broken"]:
                bricks -= info["bricks_broken"]
                print(f"after {decisions / 15:4.1f} s of play, bricks left: {bricks}")
            if terminated or info["rounds_cleared"]:
                break
    print("the ball is lost" if terminated else f"cleared, with {info['score']} points")


if __name__ == "__main__":
    main()
