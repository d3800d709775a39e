"""The page's games have the bits of the processor, in Chromium as in Node.js."""

import zlib
from typing import Any

import numpy as np
import pytest
from arkanoid.envs.batch.batch import Batch
from arkanoid.envs.batch.recorder import CHECKED, Checked
from arkanoid.envs.browser.manifest import browser_games
from arkanoid.envs.levels.files import CAMPAIGN
from arkanoid.envs.levels.generator import MAX_SEED
from arkanoid.envs.state import ABSENT

ALL = np.ones(1, np.bool_)
# Of each game: the checksum of all states, decision by decision, episode after episode.
CHECKSUMS = """async ([name, games]) => {
  const game = await arkanoid.arkanoid.open(name);
  return games.map(({ reset, actions }) => {
    game.reset(reset);
    game.record.checksum = 0;
    for (const action of actions) {
      if (game.over) game.reset();
      game.step(action);
      game.note();
    }
    return game.record.checksum;
  });
}"""
NAMES = {"levelSeed": "seed", "level": "level", "difficulty": "difficulty"}


def follow_ball(batch: Batch, luck: np.random.Generator) -> int:
    """Return an action that brings a part of the paddle, any part, below the lowest ball."""
    world = batch.worlds[0]
    there = world["ball_state"] != ABSENT
    ball = np.where(there, world["ball_y"], np.inf).argmin()
    way = world["ball_x"][ball] - world["paddle_x"] + luck.uniform(-0.7, 0.7)
    steer = 0 if abs(way) < 0.2 else 1 + int(way > 0.0)
    return steer + 3 * int(luck.integers(2))


def play(
    name: str, reset: dict[str, Any], count: int, seed: int, follows: bool = True
) -> tuple[list[int], int]:
    """Play here; return the actions, and the checksum of all states."""
    batch = Batch(1, browser_games()[name])
    options = {NAMES[key]: value for key, value in reset.items() if key != "seed"}
    batch.reset(ALL, options, [reset["seed"]])
    luck = np.random.default_rng(seed)
    checked, checksum, actions = np.zeros((), Checked), 0, []
    for _ in range(count):
        if batch.worlds["done"][0]:
            batch.reset(ALL)
        actions.append(
            follow_ball(batch, luck) if follows else int(luck.integers(6 if name == "full" else 3))
        )
        batch.command(np.array(actions[-1:]))
        batch.step()
        for field in CHECKED:
            checked[field] = batch.worlds[field][0]
        checksum = zlib.crc32(checked.tobytes(), checksum)
    return actions, checksum


@pytest.mark.parametrize("name", ["full", "lite"])
def test_ten_thousand_decisions(page: Any, name: str) -> None:
    actions, checksum = play(name, {"seed": 5}, 10_000, 8, follows=False)
    games = [{"reset": {"seed": 5}, "actions": actions}]
    assert page.evaluate(CHECKSUMS, [name, games]) == [checksum]


def starts() -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Return 200 generated levels, easy and hard ones; and all named rounds, the boss last."""
    seeds = np.random.default_rng(6).integers(min(MAX_SEED, 2**53), size=200)
    levels = [
        {"seed": 1, "levelSeed": int(seed), "difficulty": index / 199}
        for index, seed in enumerate(seeds)
    ]
    return levels, [{"seed": 2, "level": number + 1} for number in range(len(CAMPAIGN))]


def test_generated_levels_and_all_named_rounds(page: Any) -> None:
    """By a player who follows the ball."""
    levels, rounds = starts()
    lengths = [150] * len(levels) + [800] * len(rounds)
    games, checksums = [], []
    for index, (reset, length) in enumerate(zip(levels + rounds, lengths, strict=True)):
        actions, checksum = play("full", reset, length, index)
        games.append({"reset": reset, "actions": actions})
        checksums.append(checksum)
    assert page.evaluate(CHECKSUMS, ["full", games]) == checksums
