"""How the game's state is laid out, and how it is read from outside."""

import numpy as np
import pytest
from arkanoid.envs import ArkanoidEnv, ArkanoidVectorEnv
from arkanoid.envs.batch.blocks import divide
from arkanoid.envs.game.rulebook import Rules
from arkanoid.envs.state import LevelEntry, Outcome, World

LINE = 64  # bytes of a processor's cache


@pytest.mark.parametrize("dtype", [World, Outcome, LevelEntry, Rules])
def test_fields_are_aligned_and_leave_no_room_between_them(dtype):
    end = 0
    for name in dtype.names:
        field, offset = dtype.fields[name][:2]
        if field.base.names is None:
            assert offset % field.base.itemsize == 0, name
        assert 0 <= offset - end < 8, name
        end = offset + field.itemsize
    used = sum(dtype[name].itemsize for name in dtype.names)
    assert dtype.itemsize - used < 8


def test_what_every_decision_touches_comes_first_and_fills_whole_lines():
    """The speed of large batches depends on it, see `arkanoid.envs.state`."""
    names = World.names
    assert World.fields["brick_hits"][1] == 5 * LINE
    assert names.index("brick_hits") < names.index("enemy_x") < names.index("first_random")
    assert World.itemsize % LINE == 0
    assert Outcome.itemsize == LINE


def test_worlds_and_observations_begin_with_a_line():
    env = ArkanoidVectorEnv(3, copy=False)
    observations, _ = env.reset(seed=0)
    for array in (env.state, observations):
        assert array.ctypes.data % LINE == 0


@pytest.mark.parametrize("num_worlds", [1, 2, 511, 512, 513, 5000])
@pytest.mark.parametrize("threads", [1, 2, 7])
def test_blocks_hold_each_world_once_and_shares_are_of_like_size(num_worlds, threads):
    shares = divide(num_worlds, threads)
    worlds = [np.concatenate([np.arange(num_worlds)[block] for block in share]) for share in shares]
    assert np.concatenate(worlds).tolist() == list(range(num_worlds))
    sizes = [len(share) for share in worlds]
    assert len(sizes) == min(threads, num_worlds)
    assert max(sizes) - min(sizes) <= 1


@pytest.mark.parametrize("worlds", [1, 3])
def test_the_state_of_an_environment_can_be_read_but_not_written(worlds):
    env = ArkanoidEnv() if worlds == 1 else ArkanoidVectorEnv(worlds)
    env.reset(seed=0)
    state = env.state
    places = np.array(state["paddle_x"])
    env.step(2 if worlds == 1 else np.full(worlds, 2))
    assert (state["paddle_x"] > places).all()
    assert (env.state["paddle_x"] == state["paddle_x"]).all()
    with pytest.raises(ValueError, match="read-only"):
        state["paddle_x"] = 0.0
    with pytest.raises(ValueError, match="read-only"):
        (state if worlds == 1 else state[0]).lives = 9
    # It could be unlocked: the view was read-only, but not the memory that it showed.
    with pytest.raises(ValueError, match="cannot set WRITEABLE flag"):
        (state if worlds > 1 else state["brick_hits"]).flags.writeable = True
    kept = state.copy()
    kept["lives"] = 9
    assert (state["lives"] == 3).all()
