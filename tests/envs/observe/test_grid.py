"""The observation `grid`: its planes show the state, and nothing else."""

import pickle

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.observe.planes import GRID_ROWS, MAX_MARKS, STATUS
from arkanoid.envs.rules import BALL_SPEED, BOSS_HITS, UNBREAKABLE
from arkanoid.envs.state import FLYING
from helpers.plays import EVERYTHING
from helpers.states import observe_anew, writable_state, writable_states

# The middles of the grid's cells, in the field's units.
CELL_X = (np.arange(11) + 0.5)[np.newaxis, :]
CELL_Y = (14.0 - (np.arange(28) + 0.5) / 2)[:, np.newaxis]


def make(**keywords):
    """Return an environment, and its world, whose state a test may change."""
    env = ArkanoidEnv(**({"frame_skip": 1, "levels": "vault"} | keywords))
    env.reset(seed=0)
    return env, writable_state(env)


def show(env):
    """Return the observation of the world as it is, without playing."""
    return observe_anew(env)[0]


def planes(env):
    """Return a grid's planes by their names; those of motions have two, or one of the paddle's."""
    grid = show(env)
    return {
        name: grid[where].squeeze(axis=0) if name[-6:] != "motion" else grid[where]
        for name, where in env.layout.items()
    }


def centre(plane):
    """Return the sum of a plane, and where the middle of its weights is."""
    plane = plane.astype(float)
    total = plane.sum()
    return total, (plane * CELL_X).sum() / total, (plane * CELL_Y).sum() / total


def test_planes_follow_each_other_and_fill_the_grid():
    for keywords, count in [({}, 21), ({"capsules": False, "enemies": False}, 10)]:
        env = ArkanoidEnv(observation="grid", **keywords)
        assert [i for where in env.layout.values() for i in range(32)[where]] == list(range(count))
        assert env.observation_space.shape == (count, 28, 11)
        assert env.observation_space.dtype == np.float32


def test_bricks_are_in_their_cells():
    env, world = make(observation="grid", levels="vault")
    world.brick_hits[15] = 200
    seen = planes(env)
    hits = world.brick_hits.reshape(18, 11).astype(float)
    breakable = (hits > 0) & (hits != UNBREAKABLE)
    assert breakable.any()
    assert (hits == UNBREAKABLE).any()
    for name in ("brick", "hits_left", "gold"):
        assert not seen[name][:2].any()
        assert not seen[name][20:].any()
    assert (seen["brick"][2:20] == breakable).all()
    assert (seen["gold"][2:20] == (hits == UNBREAKABLE)).all()
    assert (seen["hits_left"][2:20] == np.where(breakable, np.minimum(hits / 8, 1.0), 0.0)).all()


def test_the_paddle_covers_its_cells():
    env, world = make(observation="grid")
    for x, half in [(5.5, 1.0), (3.21, 1.5), (1.0, 1.0), (10.0, 1.0)]:
        world.paddle_x, world.paddle_half, world.paddle_vx = x, half, -0.095
        seen = planes(env)
        total, middle_x, _ = centre(seen["paddle"])
        # Cells that are covered in part show how much of them, so the width is the sum.
        assert total == pytest.approx(2 * half, abs=1e-6)
        covered = seen["paddle"][24] > 0
        assert abs(middle_x - x) < 0.5
        assert (np.abs(CELL_X[0][covered] - x) < half + 0.5).all()
        assert not np.delete(seen["paddle"], 24, axis=0).any()
        np.testing.assert_allclose(seen["paddle_motion"][0], -0.5 * seen["paddle"], atol=1e-6)


def places(world, name):
    """Return what a thing's places in the record are called, set to a place in mid-field."""
    world[f"{name}_x"][1] = 3.3
    world[f"{name}_y"][1] = 4.13
    world[f"{name}_state"][1] = FLYING


def test_what_moves_is_seen_where_it_is():
    """By the middle of its weights, which share its place exactly, not rounded to a cell."""
    env, world = make(observation="grid")
    world.ball_state[0] = 0
    for name in ("ball", "beam", "enemy", "shard"):
        places(world, name)
    world.beams = world.enemies = world.shards = world.capsule = 1
    world.capsule_x, world.capsule_y = 3.3, 4.13
    fastest = BALL_SPEED * 2.75
    world.ball_vx[1], world.ball_vy[1] = 0.6 * fastest, -0.8 * fastest
    world.enemy_vx[1], world.enemy_vy[1] = 0.06, -0.08
    world.shard_vx[1], world.shard_vy[1] = 0.048, -0.064
    seen = planes(env)
    for name in ("ball", "beam", "enemy", "shard", "capsule"):
        assert centre(seen[name]) == pytest.approx((1.0, 3.3, 4.13), abs=1e-6)
        assert (seen[name] != 0).sum() == 4
    for name in ("ball", "enemy", "shard"):
        np.testing.assert_allclose(seen[f"{name}_motion"][0], 0.6 * seen[name], atol=1e-6)
        np.testing.assert_allclose(seen[f"{name}_motion"][1], -0.8 * seen[name], atol=1e-6)
    assert not seen["ball_held"].any()
    assert not seen["exit"].any()


def test_what_is_at_an_edge_keeps_its_weight():
    env, world = make(observation="grid")
    for x, y, column, row in [(0.125, 0.0, 0, 27), (10.875, 13.9, 10, 0), (5.5, -1.0, 5, 27)]:
        world.ball_x[0], world.ball_y[0] = x, y
        ball = planes(env)["ball"]
        assert ball.sum() == pytest.approx(1.0, abs=1e-6)
        assert ball[row, column] > 0.65


def test_things_in_one_cell_are_added_up_to_one():
    env, world = make(observation="grid")
    for ball in range(3):
        world.ball_state[ball] = FLYING
        world.ball_x[ball], world.ball_y[ball] = 3.5, 4.25
        world.ball_vx[ball], world.ball_vy[ball] = 0.3, -0.4
    seen = planes(env)
    assert (seen["ball"].max(), seen["ball_motion"].min()) == (1.0, -1.0)
    assert seen["ball_motion"].max() <= 1.0


def test_a_held_ball_shows_how_long():
    env, world = make(observation="grid")
    world.ball_release[0] = 30
    seen = planes(env)
    np.testing.assert_allclose(seen["ball_held"], 0.25 * seen["ball"], atol=1e-6)
    assert centre(seen["ball"])[1:] == pytest.approx((5.5, 2.125), abs=1e-6)


def test_gates_and_the_boss():
    env, world = make(observation="grid")
    world.exit_open = 1
    world.enemy_wait, world.enemy_gate = 30, 1
    seen = planes(env)
    assert np.argwhere(seen["exit"]).tolist() == [[24, 10]]
    total, x, _ = centre(seen["gate"])
    assert (total, x) == pytest.approx((1.0, 8.25), abs=1e-6)
    assert seen["gate"][0].sum() == pytest.approx(1.0, abs=1e-6)
    assert not seen["boss"].any()
    env, world = make(observation="grid", levels="warden")
    world.boss_hits = 4
    total, x, y = centre(planes(env)["boss"])
    # A quarter of its hits is left, of each cell that it covers: 3.5 by 2.75, of cells of 1/2.
    assert total == pytest.approx(3.5 * 2.75 * 2 / 4, abs=1e-5)
    assert x == pytest.approx(5.5, abs=1e-6)
    assert abs(y - 10.0) < 0.25


def test_numbers_without_a_place_fill_their_rows():
    env, world = make(observation="grid", max_decisions=100)
    world.speed_stage, world.idle, world.decisions, world.lives = -1, 900, 25, 2
    world.power, world.capsule, world.beam_wait, world.enemy_wait = 3, 5, 6, 300
    expected = {
        "speed_stage": -1 / 7, "idle_clock": 0.25, "decision_clock": 0.25, "lives": 0.5,
        "laser": 1.0, "capsule_disrupt": 1.0, "beam_wait": 0.4, "enemy_wait": 0.5,
    }  # fmt: skip
    status = planes(env)["status"]
    for name, row in STATUS.items():
        assert status[row] == pytest.approx(np.full(11, expected.get(name, 0.0)), abs=1e-6)
    assert not status[len(STATUS) :].any()
    env, world = make(observation="grid", levels="warden")
    world.shard_wait = 45
    assert planes(env)["status"][STATUS["shard_wait"]] == pytest.approx(np.full(11, 0.5))
    assert not planes(env)["status"][STATUS["enemy_wait"]].any()


def test_nothing_stays_in_a_grid_that_is_gone_in_the_game():
    """Only what changes is written; it must be what a grid written from scratch shows."""
    keywords = EVERYTHING | {"autoreset_mode": "SameStep", "observation": "grid"}
    env, fresh = ArkanoidVectorEnv(16, **keywords), ArkanoidVectorEnv(16, **keywords)
    env.reset(seed=0, options={"level": "warden"})
    env.action_space.seed(0)
    for step in range(1500):
        if step == 700:
            env.reset(options={"level": None})
        observations = env.step(env.action_space.sample())[0]
        assert env.observation_space.contains(observations)
        if step % 10 == 0:
            writable_states(fresh)[:] = env.state
            assert observations.tobytes() == observe_anew(fresh, 0.0).tobytes()


def test_the_fullest_grid_can_be_erased():
    env, world = make(observation="grid", levels="warden", paddle=5.0)
    generator = np.random.default_rng(0)
    for name in ("ball", "beam", "enemy", "shard"):
        count = len(world[f"{name}_state"])
        world[f"{name}_state"] = FLYING
        world[f"{name}_x"] = generator.uniform(1, 10, count)
        world[f"{name}_y"] = generator.uniform(1, 13, count)
        if name != "beam":
            world[f"{name}_vx"] = world[f"{name}_vy"] = 0.01
    world.ball_state[:] = 1
    world.ball_release[:] = 9
    world.paddle_vx = 0.1
    world.beams, world.enemies, world.shards, world.boss_hits = 4, 3, 4, BOSS_HITS
    world.capsule, world.capsule_x, world.capsule_y, world.exit_open = 1, 3.3, 3.3, 1
    show(env)
    assert 150 < env._batch.observer._marks[0, 0] <= MAX_MARKS


def test_grid_rows_fill_the_field():
    assert GRID_ROWS == 28


def test_a_grid_that_was_written_into_is_refused_as_a_state():
    """It ended in a crash: each filled cell was noted as one to be erased, past the list's end."""
    env = ArkanoidVectorEnv(3, copy=False, observation="grid")
    observations, _ = env.reset(seed=1)
    observations += 0.5  # in place, as when somebody normalises
    other = ArkanoidVectorEnv(3, observation="grid")
    other.reset(seed=2)
    for enter in (lambda: pickle.loads(pickle.dumps(env)), lambda: other.restore(env.snapshot())):
        with pytest.raises(ValueError, match="observation"):
            enter()
    other.step(np.zeros(3, int))
