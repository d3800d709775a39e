"""Games on another processor, an AArch64, have the bits of this one: states and observations."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arkanoid.envs.actions import COMMANDS
from arkanoid.envs.batch.batch import Batch
from arkanoid.envs.browser.entries import ENTRIES
from arkanoid.envs.browser.image import lay_out
from arkanoid.envs.browser.manifest import browser_games
from arkanoid.envs.browser.records import Game
from arkanoid.envs.config import Config
from arkanoid.envs.levels.plan import plan_levels
from arkanoid.envs.observe.planes import GridObserver
from arkanoid.envs.observe.vector import VectorObserver
from arkanoid.envs.state import GAME_OVER, World
from helpers.arm import FIRST, ArmMachine, make_program
from helpers.plays import EVERYTHING

ALL = np.ones(1, np.bool_)
SEED = 11
DECISIONS = 3000
PART = 50  # decisions after which all is compared
NEEDED = [entry for entry in ENTRIES if entry.name in ("seed", "reset", "step", "vector", "grid")]
GAMES = {
    **{name: browser_games()[name] for name in ("full", "lite")},
    "all and physical": Config.from_keywords(
        {**EVERYTHING, "deflection": "physical", "landing": True, "actions": "discrete6"}
    ),
}


class ArmGame:
    """A game that an `ArmMachine` plays."""

    def __init__(self, machine: ArmMachine, config: Config) -> None:
        self._machine = machine
        self._at = lay_out(config, plan_levels(config))
        self._game = self._at.addresses["game"]
        content = np.frombuffer(self._at.content.ljust(self._at.length, b"\0"), np.uint8)
        machine.put(FIRST, content.tobytes())
        arrays = content[self._game - FIRST :][: Game.itemsize].view(Game)["arrays"][0]
        self._actions = int(arrays["actions"])
        self._outcome = int(arrays["outcomes"])

    def begin(self) -> None:
        """Begin the first game."""
        seed = Game.fields["seed"][1]
        done, place = World.fields["done"][:2]
        self._machine.put(self._game + seed, np.uint64(SEED).tobytes())
        self._machine.call("seed", self._game)
        over = np.array(GAME_OVER, done).tobytes()
        self._machine.put(self._at.addresses["world"] + place, over)
        self.reset()

    def reset(self) -> None:
        self._machine.call("reset", self._game)

    def step(self, action: int) -> None:
        self._machine.put(self._actions, np.int64(action).tobytes())
        self._machine.call("step", self._game)

    def show(self, outcome_size: int) -> None:
        """Ask for the state, the outcome and the observations."""
        self._machine.get(self._at.addresses["world"], World.itemsize)
        self._machine.get(self._outcome, outcome_size)
        for kind in ("vector", "grid"):
            self._machine.call(kind, self._game)
            self._machine.get(self._at.addresses[kind], 4 * int(np.prod(self._at.shapes[kind])))


def observers(config: Config, batch: Batch) -> Callable[[], list[Any]]:
    """Return what observes a batch of one game."""
    made = VectorObserver(config, 1), GridObserver(config, 1)
    shared = batch.worlds, batch.rules, slice(0, 1)
    observe = [each.part(*shared) for each in made]

    def look() -> list[Any]:
        for each in observe:
            each(ALL)
        return [each.observations for each in made]

    return look


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_program(NEEDED, tmp_path_factory.mktemp("arm"))


@pytest.mark.parametrize("name", GAMES)
def test_games_are_those_of_this_processor(program: Path, name: str) -> None:
    """Random play, game after game."""
    config = GAMES[name]
    machine = ArmMachine(program, NEEDED)
    there, batch = ArmGame(machine, config), Batch(1, config)
    look = observers(config, batch)
    there.begin()
    batch.reset(ALL, {}, [SEED])
    wanted: list[bytes] = []
    luck = np.random.default_rng(5)
    for decision, action in enumerate(luck.integers(len(COMMANDS[config.actions]), size=DECISIONS)):
        if batch.worlds["done"][0]:
            batch.reset(ALL)
            there.reset()
        batch.command(np.array([action]))
        batch.step()
        there.step(action)
        if decision % PART == 0:
            wanted += [batch.worlds.tobytes(), batch.outcomes.tobytes()]
            there.show(batch.outcomes.nbytes)
            wanted += [shown.tobytes() for shown in look()]
    found = machine.run()
    for number, one in enumerate(wanted):
        assert found[: len(one)] == one, ("state", "outcome", "vector", "grid")[number % 4]
        found = found[len(one) :]
    assert not found
