"""The observations `grid` and `rgb`: what they show is what the state says, and nothing else."""

import hashlib

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.draw.palette import LUMA
from arkanoid.envs.draw.picture import draw_world
from arkanoid.envs.observe.planes import GRID_ROWS, MAX_MARKS, STATUS
from arkanoid.envs.rules import BALL_SPEED, BOSS_HITS, UNBREAKABLE
from arkanoid.envs.state import FLYING
from gymnasium.utils.env_checker import check_env
from helpers.processes import COMPILED, INTERPRETED, run_program
from helpers.states import latest_observations, observe_anew, writable_state, writable_states

EVERYTHING = {"capsule_rate": 1.0, "lives": 2, "speed": 2.0, "max_decisions": 200}
KINDS = [
    {"observation": "grid"},
    {"observation": "grid", "capsules": False, "enemies": False},
    {"observation": "rgb", "grey": True, "stack": 4},
    {"observation": "rgb", "size": (50, 40)},
]

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


def play(env, steps, seed=0):
    """Yield the observations of a random play."""
    yield env.reset(seed=seed)[0]
    env.action_space.seed(seed)
    for _ in range(steps):
        observation, _, terminated, truncated, _ = env.step(env.action_space.sample())
        yield observation
        if terminated or truncated:
            yield env.reset()[0]


# The grid.


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


# Pictures.


@pytest.mark.parametrize("size", [84, (84, 84), [60, 100], (210, 160), 7])
def test_channels_are_those_of_rendered_pictures(size):
    env = ArkanoidEnv(observation="rgb", size=size, **EVERYTHING)
    height, width = (size, size) if isinstance(size, int) else size
    assert env.observation_space.shape == (3, height, width)
    for observation in play(env, 150):
        # The world is unchanged since it was observed, but for one that has been reset.
        picture = draw_world(env._batch.worlds, env._batch.rules, 0, height, width)
        assert observation.dtype == np.uint8
        assert (observation == picture.transpose(2, 0, 1)).all()
        for channel, name in enumerate(("red", "green", "blue")):
            assert (observation[env.layout[name]] == picture[np.newaxis, :, :, channel]).all()


def test_grey_is_the_brightness():
    grey = ArkanoidEnv(observation="rgb", grey=True, **EVERYTHING)
    colour = ArkanoidEnv(observation="rgb", **EVERYTHING)
    assert grey.observation_space.shape == (1, 84, 84)
    for one, three in zip(play(grey, 200), play(colour, 200), strict=True):
        brightness = np.tensordot(LUMA, three.astype(float), 1)
        # Each layer that is mixed into a pixel is rounded: by up to a half, in either picture.
        assert np.abs(one[0] - brightness).max() <= 2.5


@pytest.mark.parametrize(("grey", "stack"), [(True, 2), (True, 4), (False, 3)])
def test_stacks_hold_the_latest_pictures_in_order(grey, stack):
    keywords = EVERYTHING | {"observation": "rgb", "grey": grey, "size": 42}
    stacked, plain = ArkanoidEnv(stack=stack, **keywords), ArkanoidEnv(**keywords)
    channels = 1 if grey else 3
    assert stacked.observation_space.shape == (stack * channels, 42, 42)
    stacked.action_space.seed(1)
    for episode in range(3):
        pictures = [plain.reset(seed=episode)[0]] * stack
        shown, over = stacked.reset(seed=episode)[0], False
        while not over:
            assert (shown == np.concatenate(pictures)).all()
            assert (shown[stacked.layout["oldest"]] == pictures[0]).all()
            assert (shown[stacked.layout["newest"]] == pictures[-1]).all()
            if not grey:
                assert (shown[stacked.layout["green"]] == [each[1] for each in pictures]).all()
            action = stacked.action_space.sample()
            shown, _, terminated, truncated, _ = stacked.step(action)
            pictures = [*pictures[1:], plain.step(action)[0]]
            over = terminated or truncated


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_a_stack_forgets_the_episode_before(mode):
    env = ArkanoidVectorEnv(
        4, autoreset_mode=mode, observation="rgb", grey=True, stack=4, size=30, max_decisions=11
    )
    env.reset(seed=0)
    env.action_space.seed(0)
    begun = 0
    for _ in range(100):
        shown, _, _, truncated, infos = env.step(env.action_space.sample())
        for world in np.flatnonzero(env.state["decisions"] == 0):
            begun += 1
            assert (shown[world] == shown[world, -1]).all()
            if mode == "SameStep":
                assert truncated[world]
                assert not (infos["final_obs"][world] == infos["final_obs"][world][-1]).all()
    assert begun >= 4 * 7


def test_pictures_that_are_kept_are_not_overwritten():
    env = ArkanoidVectorEnv(2, observation="rgb", stack=4, size=30)
    kept = [env.reset(seed=0)[0]]
    digests = [hashlib.sha256(kept[0].tobytes()).digest()]
    for _ in range(40):
        kept.append(env.step(env.action_space.sample())[0])
        digests.append(hashlib.sha256(kept[-1].tobytes()).digest())
    assert [hashlib.sha256(one.tobytes()).digest() for one in kept] == digests
    assert all(one.flags.c_contiguous for one in kept)


@pytest.mark.parametrize("kind", KINDS)
def test_without_copies_the_memory_is_the_same(kind):
    for copy in (True, False):
        env = ArkanoidVectorEnv(2, copy=copy, **kind)
        first = env.reset(seed=0)[0]
        second = env.step(np.array([1, 2]))[0]
        assert np.may_share_memory(first, second) is not copy
        assert env.observation_space.contains(second)


# All kinds.


@pytest.mark.parametrize("kind", KINDS)
def test_a_restored_state_goes_on_bit_for_bit(kind):
    """From any place of the row in which a stack moves, into an environment with a past."""
    env, other = ArkanoidEnv(**EVERYTHING, **kind), ArkanoidEnv(**EVERYTHING, **kind)
    for _ in play(other, 60, seed=9):
        pass
    env.reset(seed=0)
    env.action_space.seed(0)
    for _ in range(25):
        for _ in range(3):
            env.step(env.action_space.sample())
        shown, _ = other.restore(env.snapshot())
        assert shown.tobytes() == latest_observations(env)[0].tobytes()
        branch = env.clone()
        for _ in range(7):
            action = env.action_space.sample()
            expected = env.step(action)[0].tobytes()
            assert other.step(action)[0].tobytes() == expected
            assert branch.step(action)[0].tobytes() == expected
            if env.state["done"]:
                assert other.reset(seed=5)[0].tobytes() == env.reset(seed=5)[0].tobytes()
                branch.reset(seed=5)


@pytest.mark.parametrize("kind", KINDS)
def test_neither_batch_size_nor_threads_change_a_bit(kind):
    envs = [
        ArkanoidVectorEnv(count, threads=threads, copy=copy, **EVERYTHING, **kind)
        for count, threads, copy in [(90, 1, True), (90, 2, True), (90, 7, False), (1, 1, False)]
    ]
    for env in envs:
        env.reset(seed=5)
    generator = np.random.default_rng(0)
    for _ in range(250):
        actions = generator.integers(0, 6, 90)
        shown = [env.step(actions[: env.num_envs])[0] for env in envs]
        for other in shown[1:]:
            assert (shown[0][: len(other)] == other).all()
    for env in envs:
        env.close()


PROGRAM = """
import hashlib
from arkanoid.envs import ArkanoidVectorEnv
digest = hashlib.sha256()
for kind in ({"observation": "grid"}, {"observation": "rgb", "grey": True, "stack": 2, "size": 28},
             {"observation": "rgb", "size": (20, 24)}):
    for level in ("vault", "warden"):
        env = ArkanoidVectorEnv(2, capsule_rate=1.0, speed=4.0, max_decisions=25, **kind)
        digest.update(env.reset(seed=1, options={"level": level})[0].tobytes())
        env.action_space.seed(0)
        for _ in range(30):
            digest.update(env.step(env.action_space.sample())[0].tobytes())
print(digest.hexdigest())
"""


def test_compiled_and_interpreted_give_the_same_bits():
    digests = {
        run_program(PROGRAM, warnings="default", changes=changes).stdout
        for changes in (COMPILED, INTERPRETED)
    }
    assert len(digests) == 1


@pytest.mark.parametrize("kind", KINDS)
def test_gymnasium_accepts_it(kind):
    check_env(gym.make("Arkanoid-v0", **kind).unwrapped)
    env = gym.make("Arkanoid-v0", **kind)
    restored = gym.make(gym.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    assert restored.unwrapped.config == env.unwrapped.config
    shape = env.observation_space.shape
    wrapped = gym.wrappers.FrameStackObservation(env, 3)
    assert wrapped.reset(seed=0)[0].shape == (3, *shape)
    wrapped = gym.wrappers.FlattenObservation(env)
    assert wrapped.reset(seed=0)[0].shape == (np.prod(shape),)
    envs = gym.make_vec("Arkanoid-v0", 2, vectorization_mode="vector_entry_point", **kind)
    assert envs.reset(seed=0)[0].shape == (2, *shape)


@pytest.mark.parametrize("kind", KINDS)
def test_stable_baselines3_accepts_it(kind):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    env = gym.make("Arkanoid-v0", **kind)
    if kind["observation"] == "rgb":
        checker.check_env(env, skip_render_check=True)
        return
    # Whatever has three axes and is no picture is taken for one: it only says so.
    with pytest.warns(UserWarning, match="an image"):
        checker.check_env(env, skip_render_check=True)


def test_stable_baselines3_learns_from_pictures_as_they_are():
    """Channels come first, and no wrapper has to turn them round."""
    stable_baselines3 = pytest.importorskip("stable_baselines3")
    from arkanoid.agents.adapter import GymnasiumVecEnv

    env = GymnasiumVecEnv(
        ArkanoidVectorEnv(
            4, autoreset_mode="SameStep", copy=False, observation="rgb", grey=True, stack=4
        )
    )
    model = stable_baselines3.PPO("CnnPolicy", env, n_steps=64, batch_size=64, n_epochs=1, seed=0)
    assert model.observation_space.shape == (4, 84, 84)
    assert model.get_env() is env
    model.learn(512)
    assert model.num_timesteps == 512


@pytest.mark.parametrize(
    ("keywords", "error", "message"),
    [
        ({"observation": "pixels"}, ValueError, "'vector', 'grid', 'rgb'"),
        ({"size": 64}, ValueError, "size=64 says how pictures look, and observation='vector'"),
        ({"observation": "grid", "stack": 4}, ValueError, "stack=4 says how pictures look"),
        ({"grey": True}, ValueError, "use observation='rgb'"),
        ({"observation": "rgb", "size": 0}, ValueError, "size must be between 1 and 4096"),
        ({"observation": "rgb", "size": (84,)}, ValueError, r"an integer or \(height, width\)"),
        ({"observation": "rgb", "size": "84"}, TypeError, r"an integer or \(height, width\)"),
        ({"observation": "rgb", "size": 84.0}, TypeError, r"an integer or \(height, width\)"),
        ({"observation": "rgb", "size": (84, 8.0)}, TypeError, "size must be an integer"),
        ({"observation": "rgb", "size": True}, TypeError, "size must be an integer"),
        ({"observation": "rgb", "grey": 1}, TypeError, "grey must be True or False"),
        ({"observation": "rgb", "stack": 0}, ValueError, "stack must be between 1 and 64"),
        ({"observation": "rgb", "stack": 2.0}, TypeError, "stack must be an integer"),
    ],
)
def test_bad_keywords_are_refused(keywords, error, message):
    with pytest.raises(error, match=message):
        ArkanoidEnv(**keywords)


def test_grid_rows_fill_the_field():
    assert GRID_ROWS == 28
