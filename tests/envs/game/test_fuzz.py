"""Any game, any play: nothing leaves its bounds, nothing hangs, and the same bits everywhere."""

import hashlib
import os
from pathlib import Path

import numpy as np
import pytest
from arkanoid.envs import ArkanoidVectorEnv
from arkanoid.envs.rules import (
    BALL_RADIUS,
    BALL_SPEED,
    CAPSULES,
    ENEMY_KINDS,
    ENLARGE,
    FIELD_HEIGHT,
    FIELD_WIDTH,
    IDLE_TICKS,
    POWERS,
    UNBREAKABLE,
)
from helpers.processes import INTERPRETED, run_program
from helpers.repository import TESTS
from helpers.states import portable_bytes, writable_states

LEVELS = ["campaign", "train", "test", "seeds:5-9", "warden", ["vault", "spiral", "warden"]]


def random_keywords(rng):
    """Return keywords of any kind of game."""
    keywords = {
        "actions": rng.choice(["discrete6", "discrete3", "box"]),
        "reward": rng.choice(["progress", "score", "sparse"]),
        "deflection": rng.choice(["angle", "zones6", "physical"]),
        "frame_skip": int(rng.choice([1, 2, 4, 7])),
        "sticky_action": float(rng.choice([0.0, 0.25])),
        "lives": int(rng.integers(1, 5)),
        "life_penalty": float(rng.choice([0.0, 0.5])),
        "levels": LEVELS[rng.integers(len(LEVELS))],
        "difficulty": [None, 0.0, 0.5, 1.0][rng.integers(4)],
        "capsules": bool(rng.random() < 0.8),
        "capsule_rate": float(rng.choice([0.12, 1.0])),
        "enemies": bool(rng.random() < 0.8),
        "speed": float(rng.choice([0.3, 1.0, 2.0, 5.0, 50.0])),
        "paddle": float(rng.choice([0.25, 1.0, 2.0, 3.5, 3.7, 5.0])),
        "max_decisions": int(rng.choice([300, 27_000])),
    }
    keywords = {k: str(v) if isinstance(v, np.str_) else v for k, v in keywords.items()}
    if not keywords["enemies"] and "warden" in keywords["levels"]:
        keywords["levels"] = "campaign"
    return keywords


def check(env, observations, rewards):
    """Assert what holds in every state of every game."""
    worlds = env.state
    assert env.observation_space.contains(observations)
    assert np.isfinite(rewards).all()
    in_play = worlds["ball_state"] > 0
    x, y = worlds["ball_x"][in_play], worlds["ball_y"][in_play]
    assert (x >= BALL_RADIUS - 1e-9).all()
    assert (x <= FIELD_WIDTH - BALL_RADIUS + 1e-9).all()
    assert (y <= FIELD_HEIGHT - BALL_RADIUS + 1e-9).all()
    assert (y >= 0.0)[np.repeat(worlds["done"] == 0, in_play.sum(axis=1))].all()
    flying = worlds["ball_state"] == 2
    speed = np.hypot(worlds["ball_vx"], worlds["ball_vy"])[flying]
    base = BALL_SPEED * env.config.speed
    assert (speed <= base * 2.75 * (1 + 1e-12)).all()
    assert (speed >= base * 0.75 * (1 - 1e-12)).all()
    ended = worlds["done"] == 1
    assert (in_play.any(axis=1) | ended).all()
    half = worlds["paddle_half"]
    assert (worlds["paddle_x"] >= half - 1e-12).all()
    assert (worlds["paddle_x"] <= FIELD_WIDTH - half + 1e-12).all()
    assert (worlds["lives"] >= 0).all()
    for name, most in [
        ("power", POWERS),
        ("capsule", CAPSULES),
        ("exit_open", 1),
        ("beams", 4),
        ("beam_wait", 15),
        ("enemies", 3),
        ("enemy_wait", 600),
        ("enemy_kind", ENEMY_KINDS - 1),
        ("boss_hits", 16),
        ("shards", 4),
        ("shard_wait", 90),
        ("idle", IDLE_TICKS),
        ("ball_release", 120),
        ("ball_bounces", 64),
    ]:
        assert (worlds[name] >= 0).all(), name
        assert (worlds[name] <= most).all(), name
    for count, state in [("beams", "beam_state"), ("enemies", "enemy_state")]:
        assert (worlds[count] == (worlds[state] > 0).sum(axis=1)).all()
    assert (worlds["shards"] == (worlds["shard_state"] > 0).sum(axis=1)).all()
    hits = worlds["brick_hits"].astype(int)
    breakable = (hits > 0) & (hits < UNBREAKABLE)
    assert (worlds["bricks_left"] == breakable.sum(axis=1)).all()
    assert (worlds["hits_left"] == (hits * breakable).sum(axis=1) + worlds["boss_hits"]).all()
    assert (worlds["hits_left"] > 0)[~ended].all()
    assert (worlds["capped"] >= 0).all()
    if not env.config.enemies:
        assert not worlds["enemies"].any()
        assert not worlds["boss_hits"].any()
    if not env.config.capsules:
        assert not worlds["power"].any()
        assert not worlds["capsule"].any()


def fuzz(seed, games, worlds, steps):
    """Play random games at random; return the ticks played."""
    rng = np.random.default_rng(seed)
    ticks = 0
    for _ in range(games):
        keywords = random_keywords(rng)
        env = ArkanoidVectorEnv(worlds, autoreset_mode="SameStep", copy=False, **keywords)
        observations, _ = env.reset(seed=int(rng.integers(1 << 30)))
        env.action_space.seed(int(rng.integers(1 << 30)))
        for step in range(steps):
            if step % 5 == 0:
                actions = env.action_space.sample()
            observations, rewards, _, _, infos = env.step(actions)
            if step % 7 == 0:
                check(env, observations, rewards)
                # Whatever play leads to, a snapshot of it is accepted.
                env.restore(env.snapshot())
            assert all((infos[key] >= 0).all() for key in infos if not key.startswith(("_", "fin")))
            if rng.random() < 0.005:
                # Something out of the ordinary: a capsule for everybody.
                caught = env.state["capsule"] == 0
                if env.config.capsules:
                    caught &= env.state["ball_state"].any(axis=1)
                    place_capsules(writable_states(env), caught, int(rng.integers(1, CAPSULES + 1)))
        ticks += worlds * steps * keywords["frame_skip"]
    return ticks


VIEWS = [
    {"observation": "vector"},
    {"observation": "vector", "landing": True},
    {"observation": "grid"},
    {"observation": "rgb", "size": 20, "grey": True, "stack": 2},
    {"observation": "dict", "size": (9, 31), "channels": "last"},
]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("view", VIEWS, ids=["-".join(map(str, view.values())) for view in VIEWS])
def test_every_observation_lies_in_its_space(view, seed):
    """In games of any kind, at every step.

    A paddle 11/3 times as wide and wider was enlarged beyond the field: it could not move, was
    drawn through the walls, and had a width of 1.36 in observations.
    """
    rng = np.random.default_rng(seed)
    for _ in range(3):
        keywords = random_keywords(rng) | view
        env = ArkanoidVectorEnv(3, autoreset_mode="SameStep", copy=False, **keywords)
        observations, _ = env.reset(seed=int(rng.integers(1 << 30)))
        env.action_space.seed(int(rng.integers(1 << 30)))
        for step in range(150):
            assert env.observation_space.contains(observations)
            if step % 30 == 10 and env.config.capsules:
                kind = ENLARGE if step == 10 else int(rng.integers(1, CAPSULES + 1))
                place_capsules(writable_states(env), env.state["capsule"] == 0, kind)
            observations, *_ = env.step(env.action_space.sample())


@pytest.mark.parametrize("paddle", [11 / 3, 3.7, 5.0])
def test_the_widest_paddle_fills_the_field(paddle):
    env = ArkanoidVectorEnv(1, paddle=paddle, frame_skip=1)
    env.reset(seed=0)
    place_capsules(writable_states(env), np.ones(1, bool), ENLARGE)
    for _ in range(30):
        observations, *_ = env.step(np.array([2]))
    world = env.state[0]
    assert (world["power"], world["paddle_half"], world["paddle_x"]) == (ENLARGE, 5.5, 5.5)
    assert observations[0, :3].tolist() == [0.0, 1.0, 0.0]


def place_capsules(worlds, mask, kind):
    """Let a capsule appear just above the paddles of a mask."""
    worlds["capsule"][mask] = kind
    worlds["capsule_x"][mask] = worlds["paddle_x"][mask]
    worlds["capsule_y"][mask] = 2.3


@pytest.mark.parametrize("seed", range(4))
def test_random_games_keep_their_bounds(seed):
    assert fuzz(seed, games=6, worlds=16, steps=250) > 20_000


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100, 120))
def test_many_random_games_keep_their_bounds(seed):
    """Together more than a hundred million ticks."""
    assert fuzz(seed, games=40, worlds=64, steps=1000) > 5_000_000


def play_hash(steps):
    """Return a digest of all bits of a few games with everything in them."""
    digest = hashlib.sha256()
    for level, keywords in [
        ("campaign", {"capsule_rate": 1.0}),
        ("seeds:0-50", {"capsule_rate": 0.5, "deflection": "zones6", "sticky_action": 0.1}),
        ("warden", {"deflection": "physical", "landing": True}),
    ]:
        env = ArkanoidVectorEnv(3, lives=2, max_decisions=250, levels=level, speed=1.5, **keywords)
        digest.update(env.reset(seed=11)[0].tobytes())
        actions = np.random.default_rng(1).integers(0, 6, (steps, 3))
        for step, row in enumerate(actions):
            if step % 40 == 20:
                place_capsules(writable_states(env), np.ones(3, bool), 1 + step // 40 % CAPSULES)
            observations, rewards, *_ = env.step(row)
            digest.update(observations.tobytes() + rewards.tobytes())
        digest.update(portable_bytes(env.state))
    return digest.hexdigest()


def test_interpreted_and_compiled_give_the_same_bits():
    program = "import test_fuzz; print(test_fuzz.play_hash(300))"
    paths = os.pathsep.join([str(TESTS), str(Path(__file__).parent)])
    changes = INTERPRETED | {"PYTHONPATH": paths}
    result = run_program(program, warnings="default", changes=changes)
    assert result.stdout.strip() == play_hash(300)


def test_the_same_bits_in_any_batch_and_from_any_snapshot():
    """Worlds 0 to 4 of 64 worlds, and of 5 that were restored from a snapshot on the way."""
    keywords = {"capsule_rate": 1.0, "speed": 2.0, "max_decisions": 150, "landing": True}
    keywords["threads"] = 1
    many, few = ArkanoidVectorEnv(64, **keywords), ArkanoidVectorEnv(5, **keywords)
    many.reset(seed=0)
    few.reset(seed=0)
    actions = np.random.default_rng(0).integers(0, 6, (600, 64))
    for row in actions[:300]:
        many.step(row)
        few.step(row[:5])
    snapshot = few.snapshot()
    for row in actions[300:400]:
        few.step(row[:5])
    few.restore(snapshot)
    for row in actions[300:]:
        one = many.step(row)
        other = few.step(row[:5])
        assert one[0][:5].tobytes() == other[0].tobytes()
        assert one[1][:5].tobytes() == other[1].tobytes()
    assert many.state[:5].tobytes() == few.state.tobytes()
