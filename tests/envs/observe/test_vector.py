"""The vector observation: every number is where its name says, and worth what the state says."""

import itertools

import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.rules import BALL_SPEED, UNBREAKABLE
from arkanoid.envs.state import CIRCLING, FLYING
from helpers.states import observe_anew, writable_state, writable_states

NOOP, RIGHT, FIRE = 0, 2, 3


def make(**keywords):
    env = ArkanoidEnv(**({"frame_skip": 1, "levels": "vault"} | keywords))
    env.reset(seed=0)
    return env, writable_state(env)


def show(env):
    """Return the observation of the world as it is, without playing."""
    (row,) = observe_anew(env, 7.0)
    return {name: row[where].tolist() for name, where in env.layout.items()}


def near(numbers):
    return pytest.approx(numbers, abs=1e-6)


def test_slices_follow_each_other_and_fill_the_observation():
    for keywords in ({}, {"capsules": False}, {"enemies": False}):
        env = ArkanoidEnv(**keywords)
        ends = [(where.start, where.stop) for where in env.layout.values()]
        assert ends[0][0] == 0
        assert all(a[1] == b[0] for a, b in itertools.pairwise(ends))
        assert env.observation_space.shape == (ends[-1][1],)
        assert ArkanoidVectorEnv(2, **keywords).layout == env.layout


def test_without_capsules_and_enemies_there_are_no_numbers_for_them():
    env = ArkanoidEnv(capsules=False, enemies=False)
    assert list(env.layout)[-1] == "bricks"
    assert env.observation_space.shape == (env.layout["bricks"].stop,)


def test_paddle_balls_and_clocks():
    env, world = make(max_decisions=100)
    env.step(RIGHT)
    world.ball_state[1] = FLYING
    world.ball_x[1], world.ball_y[1] = 11.0, 7.0
    world.ball_vx[1], world.ball_vy[1] = BALL_SPEED * 2.75 * 0.6, -BALL_SPEED * 2.75 * 0.8
    world.idle, world.decisions, world.speed_stage, world.lives = 900, 25, -1, 2
    seen = show(env)
    x = (5.5 + 0.19) / 5.5 - 1
    assert seen["paddle"] == near([x, 1 / 5.5, 1.0])
    assert seen["ball_in_play"] == [1, 1, 0]
    assert seen["ball_held"] == [1, 0, 0]
    assert seen["ball_x"] == near([x, 1.0, 0.0])
    assert seen["ball_y"] == near([2.125 / 7 - 1, 0.0, 0.0])
    assert seen["ball_vx"] == near([0.0, 0.6, 0.0])
    assert seen["ball_vy"] == near([0.0, -0.8, 0.0])
    assert seen["ball_release"] == near([59 / 120, 0, 0])
    assert seen["speed_stage"] == near([-1 / 7])
    assert seen["idle_clock"] == near([0.25])
    assert seen["decision_clock"] == near([0.25])
    assert seen["lives"] == near([0.5])


def test_bricks():
    env, world = make()
    values = {0: 0.0, UNBREAKABLE: -1.0}
    expected = [values.get(int(h), min(int(h), 8) / 8) for h in world.brick_hits]
    assert show(env)["bricks"] == near(expected)
    assert -1.0 in expected


def test_capsules_powers_and_beams():
    env, world = make()
    world.power, world.exit_open, world.capsule = 3, 1, 5
    world.capsule_x, world.capsule_y = 2.75, 10.5
    world.beams, world.beam_wait = 1, 6
    world.beam_state[2], world.beam_x[2], world.beam_y[2] = FLYING, 8.25, 3.5
    seen = show(env)
    assert seen["power"] == [0, 0, 1]
    assert seen["exit_open"] == [1]
    assert seen["capsule"] == [0, 0, 0, 0, 1, 0, 0]
    assert (seen["capsule_x"], seen["capsule_y"]) == ([-0.5], [0.5])
    assert seen["beam_wait"] == near([0.4])
    assert seen["beam_in_play"] == [0, 0, 1, 0]
    assert seen["beam_x"] == [0, 0, 0.5, 0]
    assert seen["beam_y"] == [0, 0, -0.5, 0]
    # All of it is gone again with the things.
    world.power = world.exit_open = world.capsule = world.beams = 0
    world.beam_state[2] = 0
    seen = show(env)
    names = ["power", "exit_open", "capsule", "capsule_x", "capsule_y", "beam_wait"]
    assert all(not any(seen[name]) for name in [*names, "beam_in_play", "beam_x", "beam_y"])


def test_enemies():
    env, world = make()
    world.enemies, world.enemy_state[1], world.enemy_kind[1] = 1, CIRCLING, 2
    world.enemy_x[1], world.enemy_y[1] = 2.75, 10.5
    world.enemy_vx[1], world.enemy_vy[1] = 0.03, -0.04
    world.enemy_wait, world.enemy_gate = 30, 1
    seen = show(env)
    assert seen["enemy_in_play"] == [0, 1, 0]
    assert seen["enemy_x"] == [0, -0.5, 0]
    assert seen["enemy_y"] == [0, 0.5, 0]
    assert seen["enemy_vx"] == near([0, 0.3, 0])
    assert seen["enemy_vy"] == near([0, -0.4, 0])
    assert seen["enemy_kind"] == [0] * 6 + [1] + [0] * 5
    assert seen["enemy_wait"] == near([0.05])
    assert seen["gate_open"] == [0, 1]
    assert (seen["boss"], seen["shard_wait"]) == ([0], [0])


def test_the_boss():
    env, world = make(levels="warden")
    world.boss_hits, world.shard_wait, world.shards = 4, 45, 1
    world.shard_state[3] = FLYING
    world.shard_x[3], world.shard_y[3] = 8.25, 3.5
    world.shard_vx[3], world.shard_vy[3] = 0.048, -0.064
    seen = show(env)
    assert (seen["boss"], seen["shard_wait"]) == ([0.25], [0.5])
    assert seen["shard_in_play"] == [0, 0, 0, 1]
    assert seen["shard_x"] == [0, 0, 0, 0.5]
    assert seen["shard_y"] == [0, 0, 0, -0.5]
    assert seen["shard_vx"] == near([0, 0, 0, 0.6])
    assert seen["shard_vy"] == near([0, 0, 0, -0.8])
    assert (seen["enemy_wait"], seen["gate_open"]) == ([0], [0, 0])


def test_what_is_written_only_when_it_changes_is_never_stale():
    """Numbers are written where they change; they must be those of a row written from scratch."""
    keywords = {"capsule_rate": 1.0, "speed": 3.0, "lives": 2, "autoreset_mode": "SameStep"}
    env = ArkanoidVectorEnv(16, **keywords)
    env.reset(seed=0, options={"level": "warden"})
    env.action_space.seed(0)
    other = ArkanoidVectorEnv(16, **keywords)
    other.reset(seed=1)
    for step in range(1500):
        if step == 700:
            env.reset(options={"level": None})
        observations = env.step(env.action_space.sample())[0]
        if step % 10 == 0:
            writable_states(other)[:] = env.state
            assert observations.tobytes() == observe_anew(other, 7.0).tobytes()
