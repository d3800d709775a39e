"""Keys and the mouse: what they command, also in `gymnasium.utils.play`."""

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.envs.batch.replays import Replay
from arkanoid.envs.play.controls import KEYS, STEPS, Controls, Key
from arkanoid.envs.rules import FIELD_WIDTH, PADDLE_SPEED
from helpers.processes import run_program
from helpers.sittings import tap


def test_key_codes_are_those_of_pygame() -> None:
    import pygame

    names = {
        "LEFT": Key.LEFT,
        "a": Key.LEFT,
        "RIGHT": Key.RIGHT,
        "d": Key.RIGHT,
        "SPACE": Key.FIRE,
        "p": Key.PAUSE,
        "r": Key.RESTART,
        "n": Key.NEXT,
        "f": Key.FULL_SCREEN,
        "PLUS": Key.FASTER,
        "EQUALS": Key.FASTER,
        "UP": Key.FASTER,
        "MINUS": Key.SLOWER,
        "DOWN": Key.SLOWER,
        "h": Key.HELP,
        "m": Key.SOUND,
        "ESCAPE": Key.QUIT,
    }
    assert {getattr(pygame, f"K_{name}"): key for name, key in names.items()} == KEYS


def test_a_held_key_moves_the_paddle_and_opposite_keys_do_not() -> None:
    controls = Controls()
    assert controls.command(5.5, PADDLE_SPEED) == (0.0, 0.0)
    controls.press(Key.LEFT)
    assert controls.command(5.5, PADDLE_SPEED) == (-1.0, 0.0)
    controls.press(Key.RIGHT)
    assert controls.command(5.5, PADDLE_SPEED) == (0.0, 0.0)
    controls.release(Key.LEFT)
    assert controls.command(5.5, PADDLE_SPEED) == (1.0, 0.0)
    controls.let_go()
    assert controls.command(5.5, PADDLE_SPEED) == (0.0, 0.0)


def test_no_tap_is_too_short_and_a_held_button_goes_on_firing() -> None:
    controls = Controls()
    tap(controls, Key.FIRE)
    assert [controls.command(5.5, PADDLE_SPEED)[1] for _ in range(3)] == [1.0, 0.0, 0.0]
    controls.press(Key.FIRE)
    assert [controls.command(5.5, PADDLE_SPEED)[1] for _ in range(3)] == [1.0, 1.0, 1.0]


def test_the_paddle_follows_keys_or_mouse_whichever_was_used_last() -> None:
    controls = Controls()
    controls.point(9.0)
    controls.press(Key.LEFT)
    assert controls.command(5.5, PADDLE_SPEED)[0] == -1.0
    controls.point(9.0)
    assert controls.command(5.5, PADDLE_SPEED)[0] == 1.0
    controls.release(Key.LEFT)
    assert controls.command(5.5, PADDLE_SPEED)[0] == 1.0


@pytest.mark.parametrize("target", [1.5, 5.5, 5.6, 7.777, 9.3])
def test_the_paddle_comes_to_the_mouse_and_stays(target: float) -> None:
    controls = Controls()
    controls.point(target)
    x = 5.5
    commands = set()
    for _ in range(60):
        velocity, _ = controls.command(x, PADDLE_SPEED)
        commands.add(velocity)
        x += velocity * PADDLE_SPEED
    assert abs(x - target) <= PADDLE_SPEED / STEPS / 2 + 1e-12
    assert controls.command(x, PADDLE_SPEED)[0] == 0.0
    assert all(-1.0 <= velocity <= 1.0 for velocity in commands)


def test_few_commands_keep_a_replay_small(game: Replay) -> None:
    """With a velocity for every pixel of the mouse, a minute of play took 60 kB."""
    controls = Controls()
    rng = np.random.default_rng(1)
    commands = set()
    for target in rng.uniform(0.0, 11.0, 5000):
        controls.point(float(target))
        commands.add(controls.command(5.5, PADDLE_SPEED)[0])
    assert len(commands) <= 2 * STEPS + 1
    assert len(game.to_bytes()) < 3000


@pytest.mark.parametrize("actions", ["discrete6", "discrete3", "discrete4", "box"])
def test_each_combination_of_keys_does_what_its_keys_say(actions: str) -> None:
    env = gym.make("Arkanoid-v0", actions=actions, levels="ripple")
    combinations = env.unwrapped.get_keys_to_action()
    assert len(combinations) == 2**5 - 1
    for codes, action in combinations.items():
        assert action in env.action_space
        env.reset(seed=3)
        world = env.unwrapped.state
        env.step(action)
        pressed = {KEYS[code] for code in codes}
        expected = (Key.RIGHT in pressed) - (Key.LEFT in pressed)
        assert np.sign(world.paddle_x - FIELD_WIDTH / 2) == expected
        served = world.ball_state[0] == 2
        can_fire = actions != "discrete3" and (actions != "discrete4" or not expected)
        assert served == (Key.FIRE in pressed and can_fire)


@pytest.mark.parametrize("keywords", ["", ", actions='box'"])
def test_gymnasiums_own_player_plays_it(keywords: str) -> None:
    """In a process of its own, because it changes Matplotlib's backend and quits pygame."""
    noop = ", noop=np.zeros(2, np.float32)" if keywords else ""
    program = f"""
import arkanoid, gymnasium as gym, numpy as np, pygame
from gymnasium.utils.play import play
env = gym.make("Arkanoid-v0", render_mode="rgb_array"{keywords})
places = []
def callback(before, after, action, reward, terminated, truncated, info):
    places.append(float(env.unwrapped.state.paddle_x))
    at = len(places)
    if at in (2, 5):
        key = pygame.K_LEFT if at == 2 else pygame.K_d
        pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=key))
    if at in (4, 7):
        key = pygame.K_LEFT if at == 4 else pygame.K_d
        pygame.event.post(pygame.event.Event(pygame.KEYUP, key=key))
    if at == 9:
        pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_ESCAPE))
play(env, fps=1000, callback=callback, seed=1{noop})
print(*np.sign(np.round(np.diff([5.5, *places]), 9)).astype(int))
"""
    printed = run_program(program, warnings="default").stdout
    assert printed.splitlines()[-1] == "0 0 -1 -1 0 1 1 0 0"
