"""Observing changes nothing in the game, however many observers look at it, and when."""

import numpy as np
import pytest
from arkanoid.envs.batch.batch import Autoreset, Batch
from arkanoid.envs.config import Config
from arkanoid.envs.observe.choice import make_observer

WORLDS = 8
LIVELY = {"capsule_rate": 1.0, "speed": 3.0, "lives": 2, "max_decisions": 400}
KINDS = [
    {"observation": "vector"},
    {"observation": "vector", "capsules": False, "enemies": False},
    {"observation": "vector", "landing": True},
    {"observation": "grid"},
    {"observation": "rgb", "size": 30},
    {"observation": "rgb", "size": 30, "grey": True},
]
EVERYWHERE = np.ones(WORLDS, bool)


class Spectator:
    """An observer of a batch's worlds beside the batch's own."""

    def __init__(self, batch):
        self.observer = make_observer(batch.config, batch.num_worlds)
        self.look = self.observer.part(batch.worlds, batch.rules, slice(0, batch.num_worlds))

    def observe(self):
        self.observer.advance()
        self.look(EVERYWHERE)
        return self.observer.observations.tobytes()


def begun(kind):
    batch = Batch(WORLDS, Config(**LIVELY | kind), Autoreset.SAME_STEP)
    for world in range(WORLDS):
        batch.seed(world, world)
    batch.reset(EVERYWHERE)
    return batch


def play(batch, decisions, seed=0):
    """Yield after each decision of random play."""
    generator = np.random.default_rng(seed)
    for _ in range(decisions):
        batch.command(generator.integers(0, 6, WORLDS))
        batch.step()
        yield


@pytest.mark.parametrize("kind", KINDS)
def test_observing_changes_no_byte_of_the_game(kind):
    """The observers once kept in the world's record which of the bricks they had shown."""
    batch = begun(kind)
    for _ in play(batch, 100):
        before = batch.worlds.tobytes()
        batch.observe(EVERYWHERE)
        assert batch.worlds.tobytes() == before


@pytest.mark.parametrize("kind", KINDS)
def test_observers_of_the_same_worlds_do_not_rob_each_other(kind):
    """The first to look once noted in the world that the bricks were shown; others missed them."""
    batch = begun(kind)
    often, seldom = Spectator(batch), Spectator(batch)
    for decision, _ in enumerate(play(batch, 400)):
        assert often.observe() == batch.observations.tobytes()
        if decision % 37 == 0:
            assert seldom.observe() == batch.observations.tobytes()
            assert Spectator(batch).observe() == batch.observations.tobytes()


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_shown_follows_restored_copied_and_pickled_states(kind):
    """Each is compared with a fresh look at the same state, also some decisions later."""
    batch, other = begun(kind), begun(kind)
    for _ in play(other, 150, seed=1):
        pass
    for _ in play(batch, 100):
        pass
    early = batch.worlds.tobytes(), batch.outcomes.tobytes(), batch.observations.tobytes()
    for _ in play(batch, 100):
        pass
    worlds, outcomes = (np.frombuffer(part, np.uint8).reshape(WORLDS, -1) for part in early[:2])
    observations = np.frombuffer(early[2], batch.observations.dtype)
    observations = observations.reshape(batch.observations.shape)
    for one in (batch, other, batch.clone(), other.clone()):
        one.restore(worlds, outcomes, observations)
        assert one.observations.tobytes() == early[2]
        for _ in play(one, 25, seed=2):
            assert Spectator(one).observe() == one.observations.tobytes()
        for _ in play(one.clone(), 5, seed=3):
            pass
        for _ in play(one, 5, seed=4):
            assert Spectator(one).observe() == one.observations.tobytes()


def test_more_changes_than_a_world_remembers_are_shown_all():
    """The beams and balls of several decisions, looked at once."""
    batch = begun({"observation": "vector"})
    spectator = Spectator(batch)
    missed = 0
    for decision, _ in enumerate(play(batch, 1500)):
        if decision % 100 == 0:
            missed += (batch.worlds["brick_changes"] - spectator.observer._shown[:, 0] > 8).any()
            assert spectator.observe() == batch.observations.tobytes()
    assert missed > 3
