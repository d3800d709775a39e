"""The ranges of the state's fields are closed: no play leads out of them."""

from typing import Any

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv
from arkanoid.envs.ranges import WORLD_RANGES
from arkanoid.envs.rules import CIRCLE_TICKS, IDLE_TICKS
from arkanoid.envs.state import CIRCLING, DIVING, HIGHEST, World
from helpers.states import writable_state

LIVELY = {"capsule_rate": 1.0, "lives": 900}
SETUPS: dict[str, dict[str, Any]] = {
    "fast": {"speed": 1000.0, "levels": "nested_rings"},
    "slow": {"levels": "train"},
    "boss": {"levels": "warden", "speed": 3.0},
    "short": {"levels": "short.txt", "speed": 100.0, "frame_skip": 2},
}
SILVER = "name: Short\n\n" + "...........\n" * 9 + "....SSSS...\n"


def started(**keywords: Any) -> ArkanoidEnv:
    env = ArkanoidEnv(**LIVELY, **keywords)
    env.action_space.seed(0)
    env.reset(seed=0)
    return env


def play(env: ArkanoidEnv, steps: int, spectator: ArkanoidEnv) -> None:
    """Play at random; another environment must take each state."""
    for _ in range(steps):
        if env.state.done:
            env.reset()
        env.step(env.action_space.sample())
        spectator.restore(env.snapshot())


def raised(env: ArkanoidEnv, snapshot: bytes, name: str, value: Any) -> bool:
    """Restore a state in which a field has another value; return whether it was accepted."""
    env.restore(snapshot)
    state = writable_state(env)
    state[name] = value
    if name in ("score", "lives"):
        # The next point brings a life.
        state["next_life"] = state["score"] + 1
    if name == "round_number":
        # In later rounds silver needs more hits.
        state["needed"] = WORLD_RANGES["needed"][1]
    try:
        env.restore(env.snapshot())
    except ValueError:
        env.restore(snapshot)
        return False
    return True


def raise_as_far_as_legal(env: ArkanoidEnv, name: str) -> Any:
    """Bring a field to its upper end, or as near as other fields allow; return its value."""
    snapshot = env.snapshot()
    whole = World[name].base.kind != "f"
    low, high = np.max(env.state[name]).item(), WORLD_RANGES[name][1]
    if not raised(env, snapshot, name, high):
        for _ in range(64):
            middle = (low + high) // 2 if whole else 0.5 * (low + high)
            low, high = (middle, high) if raised(env, snapshot, name, middle) else (low, middle)
        raised(env, snapshot, name, low)
        high = low
    return high


@pytest.mark.parametrize("setup", SETUPS)
def test_play_from_the_upper_end_of_a_range_stays_within(
    setup: str, tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After one more hit, a forged `hits_since_serve` of 2^30 was beyond its range.

    The environment refused its own snapshot. So it was with points, lives, rounds, changes of
    bricks and capped ticks.
    """
    monkeypatch.chdir(tmp_path)
    (tmp_path / "short.txt").write_text(SILVER)
    env, spectator = started(**SETUPS[setup]), ArkanoidEnv(**LIVELY, **SETUPS[setup])
    counted = dict.fromkeys(WORLD_RANGES, False)
    for moment in range(2):
        play(env, 40 + 200 * moment, spectator)
        snapshot = env.snapshot()
        for name in WORLD_RANGES:
            env.restore(snapshot)
            for _ in range(20):
                before = env.state.copy()[name]
                env.step(env.action_space.sample())
                counted[name] |= bool((env.state[name] > before).any())
            env.restore(snapshot)
            raise_as_far_as_legal(env, name)
            play(env, 20, spectator)
        env.restore(snapshot)
    # What would have left its range did count.
    assert counted["score"] or setup == "boss"
    assert counted["hits_since_serve"] or setup != "slow"
    assert counted["capped"] or setup != "fast"
    assert counted["round_number"] or setup != "short"


@pytest.mark.parametrize("name", ["score", "lives", "round_number", "hits_since_serve", "capped"])
def test_counters_without_a_bound_are_legal_at_their_ends(name: str) -> None:
    env = started(levels="nested_rings")
    assert raise_as_far_as_legal(env, name) == WORLD_RANGES[name][1]
    assert env.state[name] == WORLD_RANGES[name][1]


def test_changes_of_bricks_are_seen_where_their_number_begins_anew() -> None:
    env = started(speed=1000.0, levels="nested_rings", observation="grid")
    assert raise_as_far_as_legal(env, "brick_changes") == WORLD_RANGES["brick_changes"][1]
    plain = env.clone()
    writable_state(plain)["brick_changes"] = 0
    for _ in range(60):
        action = env.action_space.sample()
        assert env.step(action)[0].tobytes() == plain.step(action)[0].tobytes()
    assert env.state.brick_changes < 10_000


def test_an_idleness_that_costs_a_life_is_not_kept() -> None:
    """With a full clock and a life, the clock went on beyond its range."""
    env = started()
    writable_state(env)["idle"] = IDLE_TICKS
    with pytest.raises(ValueError, match="idle is 3600, which does not go with"):
        env.restore(env.snapshot())
    writable_state(env)["idle"] = IDLE_TICKS - 1
    writable_state(env)["lives"] = 1
    env.restore(env.snapshot())
    assert env.step(0)[2]
    assert env.state.idle == IDLE_TICKS
    env.restore(env.snapshot())


@pytest.mark.parametrize(
    ("state", "field", "end"),
    [(CIRCLING, "enemy_clock", CIRCLE_TICKS), (DIVING, "enemy_y", HIGHEST)],
)
def test_enemies_at_the_ends_of_their_ranges_stay_within(state: int, field: str, end: Any) -> None:
    """They circled longer than enemies do, or flew higher than any place that is legal."""
    env = started()
    world = writable_state(env)
    values = {"x": 6.5, "y": 6.0, "course_y": 1.0, "side": 1.0, "state": state, "kind": 0}
    for name, value in values.items():
        world[f"enemy_{name}"][0] = value
    world[field][0] = end
    world["enemies"] = 1
    env.restore(env.snapshot())
    for _ in range(5):
        env.step(0)
        assert env.state.enemies > 0
        env.restore(env.snapshot())
