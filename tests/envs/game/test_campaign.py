"""Which rounds are played, and how a reset chooses where an episode begins."""

import arkanoid  # noqa: F401
import gymnasium as gym
import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.levels import CAMPAIGN, load_level
from arkanoid.envs.levels.generator import FIRST_TEST_SEED, TRAIN_SEEDS, lay_level
from arkanoid.envs.levels.plan import TEST_SEEDS, seed_range
from arkanoid.envs.rules import UNBREAKABLE
from gymnasium.vector import AutoresetMode
from helpers.states import writable_state

NOOP = 0


def make(**keywords):
    env = ArkanoidEnv(**({"frame_skip": 1} | keywords))
    env.reset(seed=0)
    return env, writable_state(env)


def clear_round(env, world):
    """Clear the round with a last hit on a brick in the middle."""
    world.brick_hits[:] = 0
    world.boss_hits = 0
    world.brick_hits[60] = 1
    world.kind[60] = 1
    world.hits_left = world.bricks_left = 1
    world.ball_state[0] = 2
    world.ball_x[0], world.ball_y[0] = 5.5, 9.8
    world.ball_vx[0], world.ball_vy[0] = 0.0, 0.176
    info = env.step(NOOP)[-1]
    assert info["rounds_cleared"] == 1
    return info


def generated(seed, difficulty):
    kinds = np.zeros(198, np.uint8)
    lay_level(kinds, seed, difficulty)
    return kinds.tobytes()


def find_seed(layout, seeds, difficulty):
    """Return the seed that makes a layout, None if none does."""
    return next((s for s in seeds if generated(s, difficulty) == layout.tobytes()), None)


def test_the_campaign_is_the_named_levels_the_boss_and_then_generated_ones_harder_and_harder():
    env, world = make()
    for number, name in enumerate(CAMPAIGN, 1):
        assert world.round_number == number
        assert world.kind.tobytes() == load_level(name).kinds.tobytes()
        assert (world.boss_hits == 16) == (name == "warden")
        clear_round(env, world)
    for index in range(14):
        difficulty = min(1.0, 0.5 + 0.05 * index)
        assert find_seed(world.kind, TRAIN_SEEDS, difficulty) is not None
        assert world.bricks_left > 0
        clear_round(env, world)


def test_silver_needs_more_hits_in_later_rounds_without_end():
    env, world = make(levels="vault")
    silver = np.array(world.kind) == 9
    assert silver.any()
    for number in range(1, 40):
        assert (world.brick_hits[silver] == 2 + (number - 1) // 8).all()
        gold = np.array(world.kind) == 10
        assert (world.brick_hits[gold] == UNBREAKABLE).all()
        clear_round(env, world)


def test_without_enemies_the_campaign_has_no_boss():
    env, world = make(enemies=False)
    for _ in CAMPAIGN[:-1]:
        assert world.boss_hits == 0
        clear_round(env, world)
    assert find_seed(world.kind, TRAIN_SEEDS, 0.5) is not None


@pytest.mark.parametrize(
    ("levels", "seeds"),
    [
        ("train", range(10_000)),
        ("test", range(1_000_000, 1_010_000)),
        ("seeds:100-103", range(100, 104)),
        (range(7, 9), range(7, 9)),
    ],
)
def test_generated_rounds_come_from_the_seeds_that_were_asked_for(levels, seeds):
    assert seed_range(levels) == seeds
    found = set()
    for difficulty in (0.0, 0.75):
        env, world = make(levels=levels, difficulty=difficulty)
        for _ in range(4):
            found.add(find_seed(world.kind, seeds, difficulty))
            clear_round(env, world)
    assert None not in found
    assert len(found) > 1


def test_no_training_seed_is_a_test_seed():
    assert TEST_SEEDS.start == FIRST_TEST_SEED
    assert set(TRAIN_SEEDS).isdisjoint(TEST_SEEDS)


def test_difficulty_rises_from_round_to_round_unless_it_is_given():
    env, world = make(levels="seeds:5-5")
    for index in range(25):
        assert world.kind.tobytes() == generated(5, min(1.0, 0.05 * index))
        clear_round(env, world)


def test_a_list_is_played_in_turn_again_and_again(tmp_path):
    level = tmp_path / "one.txt"
    level.write_text("w..........\n")
    env, world = make(levels=["comb", str(level)])
    for number in range(6):
        expected = load_level("comb" if number % 2 == 0 else str(level))
        assert world.kind.tobytes() == expected.kinds.tobytes()
        clear_round(env, world)


def test_the_score_does_not_saturate_with_the_last_level():
    """A game that ended, or stood still, after its last level would reward no skill beyond it."""
    env, world = make()
    scores = []
    for _ in range(40):
        scores.append(clear_round(env, world)["score"])
        assert world.needed > 0
        assert world.ball_state[0] == 1
    assert (np.diff(scores) > 0).all()


def test_a_new_round_keeps_lives_score_and_power_but_nothing_that_flies():
    env, world = make()
    world.power, world.lives, world.score = 1, 5, 100
    world.capsule, world.capsule_y = 4, 9.0
    world.exit_open = 1
    clear_round(env, world)
    assert (world.power, world.lives, world.score) == (1, 5, 150)
    assert (world.capsule, world.exit_open, world.beams, world.enemies) == (0, 0, 0, 0)
    assert np.array(world.ball_state).tolist() == [1, 0, 0]


class TestResetOptions:
    def test_a_level_by_its_name_begins_at_its_round(self):
        env, world = make()
        info = env.reset(options={"level": "vault"})[1]
        assert info["round"] == 11
        assert world.kind.tobytes() == load_level("vault").kinds.tobytes()
        clear_round(env, world)
        assert world.kind.tobytes() == load_level("switchback").kinds.tobytes()

    def test_the_boss_can_be_asked_for(self):
        env, world = make()
        env.reset(options={"level": "warden"})
        assert (world.round_number, world.boss_hits) == (13, 16)

    def test_any_other_level_is_the_first_round(self, tmp_path):
        level = tmp_path / "one.txt"
        level.write_text("w..........\n")
        env, world = make()
        info = env.reset(options={"level": str(level)})[1]
        assert (info["round"], info["bricks_left"]) == (1, 1)
        env, world = make(levels="train")
        env.reset(options={"level": "warden"})
        assert (world.round_number, world.boss_hits) == (1, 16)

    def test_a_number_is_a_round(self):
        env, world = make()
        env.reset(options={"level": 20})
        assert world.round_number == 20
        assert find_seed(world.kind, TRAIN_SEEDS, 0.5 + 0.05 * 6) is not None

    def test_a_seed_generates_the_first_round(self):
        env, world = make()
        env.reset(options={"seed": 1_000_007, "difficulty": 0.25})
        assert world.kind.tobytes() == generated(1_000_007, 0.25)

    def test_difficulty_is_that_of_all_generated_rounds(self):
        env, world = make(levels="seeds:3-3", difficulty=0.9)
        env.reset(options={"difficulty": 0.125})
        for _ in range(3):
            assert world.kind.tobytes() == generated(3, 0.125)
            clear_round(env, world)

    def test_they_stay_in_force_until_a_reset_says_otherwise(self):
        env, world = make(levels="seeds:3-3")
        env.reset(options={"seed": 8, "difficulty": 1.0})
        for _ in range(2):
            env.reset()
            assert world.kind.tobytes() == generated(8, 1.0)
        env.reset(options={"seed": None})
        assert world.kind.tobytes() == generated(3, 1.0)
        env.reset(options={"difficulty": None})
        assert world.kind.tobytes() == generated(3, 0.0)

    def test_they_do_not_change_the_games_random_numbers(self):
        env, world = make()
        env.reset(seed=4)
        state = int(world.random)
        env.reset(seed=4, options={"level": "comb"})
        assert int(world.random) == state

    def test_in_the_vector_env_they_hold_for_the_masked_worlds(self):
        env = ArkanoidVectorEnv(3, autoreset_mode=AutoresetMode.SAME_STEP, max_decisions=2)
        env.reset(seed=0)
        mask = np.array([False, True, False])
        env.reset(options={"reset_mask": mask, "level": "comb"})
        for _ in range(5):  # through automatic resets
            assert env.state["round_number"].tolist() == [1, 6, 1]
            infos = env.step(np.zeros(3, int))[-1]
        assert infos["round"].tolist() == [1, 6, 1]

    @pytest.mark.parametrize(
        ("options", "error", "message"),
        [
            ({"levl": "comb"}, ValueError, "did you mean 'level'"),
            ({"level": "combb"}, ValueError, "Did you mean 'comb'"),
            ({"level": 0}, ValueError, "between 1 and"),
            ({"level": 1.5}, TypeError, "must be an integer"),
            ({"seed": -1}, ValueError, "between 0 and"),
            ({"difficulty": 1.5}, ValueError, "between 0 and 1"),
            ({"difficulty": "hard"}, TypeError, "must be a number"),
            ({"level": "comb", "seed": 1}, ValueError, "either a level or a seed"),
        ],
    )
    def test_illegal_ones_are_refused_and_change_nothing(self, options, error, message):
        for env in (ArkanoidEnv(), ArkanoidVectorEnv(2)):
            env.reset(seed=0)
            before = env.state.tobytes()
            with pytest.raises(error, match=message):
                env.reset(options=options)
            assert env.state.tobytes() == before

    def test_the_boss_is_refused_where_there_are_no_enemies(self):
        env, _ = make(enemies=False)
        with pytest.raises(ValueError, match="'warden' has the boss"):
            env.reset(options={"level": "warden"})


@pytest.mark.parametrize(
    ("levels", "message"),
    [
        ("seeds:9-3", "not empty"),
        ("seeds:3", "seed:7, and several as seeds:100-200"),
        (range(0), "not empty"),
        (range(0, 10, 2), "step 1"),
        (range(-5, 5), "from 0 to"),
        ("seeds:0-99999999999999999999", "several as seeds:100-200"),
    ],
)
def test_illegal_ranges_of_seeds_are_refused(levels, message):
    with pytest.raises(ValueError, match=message):
        ArkanoidEnv(levels=levels)


def test_lite_is_the_game_without_capsules_and_enemies_and_with_three_actions():
    env = gym.make("ArkanoidLite-v0")
    config = env.unwrapped.config
    assert (config.capsules, config.enemies, config.actions) == (False, False, "discrete3")
    assert env.action_space.n == 3
    assert gym.make("ArkanoidLite-v0", actions="discrete6").action_space.n == 6
    env = gym.make_vec("ArkanoidLite-v0", 2, "vector_entry_point")
    assert env.single_action_space.n == 3
