"""Playing by hand and looking at replays: keys and mouse, pauses, what is kept."""

import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import arkanoid  # noqa: F401
import gymnasium as gym
import imageio.v3 as iio
import numpy as np
import pytest
from arkanoid.agents import cli
from arkanoid.agents.commands.play import free_path
from arkanoid.envs.batch.playback import play_replay, replay_frames, replay_states
from arkanoid.envs.batch.replays import Replay
from arkanoid.envs.draw.overlay import draw_overlay
from arkanoid.envs.draw.picture import draw_world
from arkanoid.envs.play import by_hand as play
from arkanoid.envs.play import show
from arkanoid.envs.play.by_hand import hand_config
from arkanoid.envs.play.controls import KEYS, STEPS, Controls, Key
from arkanoid.envs.play.show import HEIGHT_STEP, run_show, screen_height
from arkanoid.envs.play.sitting import OVER_TICKS, TITLE_TICKS, WARNING_TICKS, Phase, Sitting
from arkanoid.envs.play.viewer import Viewer
from arkanoid.envs.rules import FIELD_WIDTH, IDLE_TICKS, PADDLE_SPEED
from PIL import Image

FAST = 10_000.0
HEIGHT = 64  # of pictures: small ones are drawn quickly


@pytest.fixture(autouse=True)
def dummy_display(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    import pygame

    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    yield
    pygame.display.quit()


def sit_down(
    level: str | None = None, kept: list[Replay] | None = None, **keywords: Any
) -> Sitting:
    """A sitting whose games go into a list."""
    config, options = hand_config(level, **keywords)
    return Sitting(config, options, 5, [].append if kept is None else kept.append, HEIGHT)


def tap(shown: Any, key: Key) -> None:
    shown.press(key)
    shown.release(key)


def play_on(sitting: Sitting, ticks: int = 10**6) -> None:
    """Follow the lowest ball with the mouse, at most for so many ticks."""
    for _ in range(ticks):
        world = sitting.world
        balls = [
            (y, x)
            for x, y, state in zip(world.ball_x, world.ball_y, world.ball_state, strict=True)
            if state
        ]
        if balls:
            sitting.point(min(balls)[1])
        sitting.tick()
        if sitting.phase is not Phase.PLAYING:
            return


def lose(sitting: Sitting) -> None:
    """Keep away from the ball until the game is over."""
    while sitting.phase is Phase.PLAYING:
        sitting.point(FIELD_WIDTH if sitting.world.ball_x[0] < FIELD_WIDTH / 2 else 0.0)
        sitting.tick()


@pytest.fixture(scope="module")
def game() -> Replay:
    """A game in which the ball is followed for a while, and then lost."""
    kept: list[Replay] = []
    sitting = sit_down("comb", kept, lives=1)
    tap(sitting, Key.FIRE)
    play_on(sitting, 400)
    lose(sitting)
    (replay,) = kept
    return replay


# ---------------------------------------------------------------- keys and mouse


def test_the_keys_codes_are_pygames() -> None:
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
        "ESCAPE": Key.QUIT,
    }
    assert {getattr(pygame, f"K_{name}"): key for name, key in names.items()} == KEYS


def test_held_keys_move_and_opposite_ones_do_not() -> None:
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


def test_of_keys_and_mouse_the_last_one_moves_the_paddle() -> None:
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
    """Velocities as fine as pixels made the replay of a minute with the mouse 60 kB large."""
    controls = Controls()
    rng = np.random.default_rng(1)
    commands = set()
    for target in rng.uniform(0.0, 11.0, 5000):
        controls.point(float(target))
        commands.add(controls.command(5.5, PADDLE_SPEED)[0])
    assert len(commands) <= 2 * STEPS + 1
    assert len(game.to_bytes()) < 3000


# ---------------------------------------------------------------- gymnasium.utils.play


@pytest.mark.parametrize("actions", ["discrete6", "discrete3", "box"])
def test_each_combination_of_keys_does_what_its_keys_say(actions: str) -> None:
    env = gym.make("Arkanoid-v0", actions=actions, levels="ripple")
    combinations = env.unwrapped.get_keys_to_action()
    assert len(combinations) == 2**5 - 1
    for codes, action in combinations.items():
        assert action in env.action_space
        env.reset(seed=3)
        world = env.unwrapped._batch.worlds[0]
        env.step(action)
        pressed = {KEYS[code] for code in codes}
        expected = (Key.RIGHT in pressed) - (Key.LEFT in pressed)
        assert np.sign(world.paddle_x - FIELD_WIDTH / 2) == expected
        served = world.ball_state[0] == 2
        assert served == (Key.FIRE in pressed and actions != "discrete3")


@pytest.mark.parametrize("keywords", ["", ", actions='box'"])
def test_gymnasiums_own_player_plays_it(keywords: str) -> None:
    """In a process of its own, for it changes Matplotlib's backend and quits pygame."""
    noop = ", noop=np.zeros(2, np.float32)" if keywords else ""
    program = f"""
import arkanoid, gymnasium as gym, numpy as np, pygame
from gymnasium.utils.play import play
env = gym.make("Arkanoid-v0", render_mode="rgb_array"{keywords})
places = []
def callback(before, after, action, reward, terminated, truncated, info):
    places.append(float(env.unwrapped._batch.worlds["paddle_x"][0]))
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
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert run.stdout.splitlines()[-1] == "0 0 -1 -1 0 1 1 0 0"


# ---------------------------------------------------------------- a sitting


def test_a_game_waits_for_its_player() -> None:
    sitting = sit_down()
    before = sitting.world.tobytes()
    for _ in range(10):
        sitting.tick()
    assert sitting.phase is Phase.READY
    assert sitting.world.tobytes() == before
    assert sitting.text()[0] == "Ripple"


def test_the_button_that_starts_a_game_does_not_serve() -> None:
    sitting = sit_down()
    sitting.press(Key.FIRE)
    for _ in range(30):
        sitting.tick()
    assert sitting.world.ball_state[0] == 1
    sitting.release(Key.FIRE)
    tap(sitting, Key.FIRE)
    sitting.tick()
    assert sitting.world.ball_state[0] == 2


@pytest.mark.parametrize("leave", [lambda s: tap(s, Key.PAUSE), Sitting.leave])
@pytest.mark.parametrize("back", [Key.PAUSE, Key.FIRE])
def test_in_a_pause_nothing_moves(leave: Callable[[Sitting], None], back: Key) -> None:
    sitting = sit_down()
    tap(sitting, Key.FIRE)
    sitting.press(Key.LEFT)
    for _ in range(20):
        sitting.tick()
    leave(sitting)
    assert sitting.text()[0] == "PAUSED"
    before = sitting.world.tobytes()
    for _ in range(20):
        sitting.tick()
    assert sitting.world.tobytes() == before
    tap(sitting, back)
    assert sitting.phase is Phase.PLAYING
    sitting.tick()
    # What was held before the pause is not held any more: its release may have gone unseen.
    assert sitting.world.paddle_vx == 0.0
    assert sitting.world.decisions == 21


def test_to_look_elsewhere_before_a_game_changes_nothing() -> None:
    sitting = sit_down()
    sitting.leave()
    tap(sitting, Key.PAUSE)
    assert sitting.phase is Phase.READY


def test_a_game_to_its_end_is_kept_and_plays_again_bit_for_bit() -> None:
    kept: list[Replay] = []
    sitting = sit_down("comb", kept, lives=1)
    tap(sitting, Key.FIRE)
    play_on(sitting, 300)
    lose(sitting)
    assert sitting.phase is Phase.OVER
    (replay,) = kept
    assert play_replay(replay).score == sitting.world.score > 0
    title, lines = sitting.text()
    assert title == "GAME OVER"
    assert f"SCORE {sitting.world.score}" in lines[0]
    sitting.close()
    assert len(kept) == 1


def test_whoever_hammers_the_button_still_sees_the_end() -> None:
    sitting = sit_down(lives=1)
    tap(sitting, Key.FIRE)
    lose(sitting)
    for _ in range(OVER_TICKS - 1):
        tap(sitting, Key.FIRE)
        sitting.tick()
    assert sitting.phase is Phase.OVER
    sitting.tick()
    tap(sitting, Key.FIRE)
    assert sitting.phase is Phase.READY
    assert (sitting.world.lives, sitting.world.decisions) == (1, 0)


@pytest.mark.parametrize("key", [Key.RESTART, Key.NEXT, None])
def test_a_game_that_is_left_is_kept(key: Key | None) -> None:
    kept: list[Replay] = []
    sitting = sit_down("vault", kept)
    tap(sitting, Key.FIRE)
    play_on(sitting, 100)
    if key is None:
        sitting.close()
    else:
        tap(sitting, key)
        assert sitting.phase is Phase.READY
        assert sitting.world.round_number == (12 if key is Key.NEXT else 11)
    (replay,) = kept
    assert play_replay(replay).decisions == 100


def test_a_game_that_was_not_begun_is_not_kept() -> None:
    kept: list[Replay] = []
    sitting = sit_down(None, kept)
    for key in (Key.NEXT, Key.RESTART, Key.NEXT, Key.NEXT):
        tap(sitting, key)
    assert sitting.world.round_number == 4
    assert sitting.text()[0] == "Hourglass"
    sitting.close()
    assert kept == []


def test_every_game_of_a_sitting_plays_again() -> None:
    kept: list[Replay] = []
    sitting = sit_down("seed:7", kept)
    for key in (Key.RESTART, Key.NEXT, Key.RESTART):
        tap(sitting, Key.FIRE)
        play_on(sitting, 150)
        tap(sitting, key)
    tap(sitting, Key.FIRE)
    play_on(sitting, 50)
    sitting.close()
    assert [play_replay(replay).decisions for replay in kept] == [150, 150, 150, 50]
    assert len({replay.start.random for replay in kept}) == 4


def test_a_new_round_says_its_name() -> None:
    sitting = sit_down(levels=["ripple", "comb"], lives=1000, speed=3.0)
    tap(sitting, Key.FIRE)
    while sitting.world.round_number == 1:
        play_on(sitting, 1)
        if not sitting.world.rounds_cleared:
            assert sitting.text() == ("", ())
    shown = 0
    while sitting.text()[0]:
        assert sitting.text() == ("Comb", ("ROUND 2",))
        play_on(sitting, 1)
        shown += 1
    assert shown == TITLE_TICKS


def test_a_player_is_warned_before_the_game_is_cut() -> None:
    sitting = sit_down("warden")
    tap(sitting, Key.FIRE)
    sitting.world.idle = IDLE_TICKS - WARNING_TICKS - 1
    # The ball lies on the paddle for longer than this lasts.
    sitting.tick()
    assert sitting.text()[1] == ("HIT A BRICK WITHIN 15 S",)
    sitting.world.idle = IDLE_TICKS - 2
    sitting.tick()
    assert sitting.text()[1] == ("HIT A BRICK WITHIN 1 S",)
    sitting.tick()
    assert sitting.phase is Phase.OVER
    assert sitting.text()[0] == "60 SECONDS WITHOUT A HIT"


@pytest.mark.parametrize(
    ("level", "round_number", "title"),
    [
        (None, 1, "Ripple"),
        ("spiral", 10, "Spiral"),
        ("warden", 13, "Warden"),
        ("seed:12", 1, "Round 1"),
        ("train", 1, "Round 1"),
        ("seeds:3-9", 1, "Round 1"),
    ],
)
def test_levels_are_chosen(level: str | None, round_number: int, title: str) -> None:
    sitting = sit_down(level)
    assert (sitting.world.round_number, sitting.text()[0]) == (round_number, title)


def test_a_generated_level_is_the_one_that_is_drawn() -> None:
    from arkanoid.envs.play.gallery import find_level

    for difficulty in (None, 0.9):
        expected = find_level("seed:12", 0.5 if difficulty is None else difficulty)
        sitting = sit_down("seed:12", difficulty=difficulty)
        for _ in range(3):
            np.testing.assert_array_equal(sitting.world.kind, expected.kinds.ravel())
            tap(sitting, Key.NEXT)


def test_a_file_of_ones_own_may_be_called_anything(tmp_path: Path) -> None:
    file = tmp_path / "mine.txt"
    file.write_text("name: Straße Nr. 7 – für Zoë\n\n.w.......X.\n", encoding="utf-8")
    sitting = sit_down(str(file))
    assert sitting.text()[0] == "Straße Nr. 7 – für Zoë"
    assert sitting.picture().shape == (HEIGHT, 48, 3)
    with pytest.raises(ValueError, match="Did you mean 'spiral'"):
        sit_down("spirol")
    with pytest.raises(ValueError, match="'warden' has the boss"):
        sit_down("warden", enemies=False)


def test_text_is_drawn_over_a_dimmed_band_or_over_the_picture_itself() -> None:
    grey = np.full((256, 192, 3), 100, np.uint8)
    plain, with_band = grey.copy(), grey.copy()
    draw_overlay(plain, "", ())
    assert (plain == grey).all()
    draw_overlay(plain, "Hello", ("WORLD",), band=False)
    draw_overlay(with_band, "Hello", ("WORLD",))
    changed = np.nonzero((plain != grey).any(axis=2))
    assert 0 < len(changed[0]) < 0.1 * 256 * 192
    # In the middle between left and right.
    assert abs(changed[1].min() - (191 - changed[1].max())) <= 3
    rows = np.flatnonzero((with_band != grey).any(axis=(1, 2)))
    assert (np.diff(rows) == 1).all()
    assert rows.min() < changed[0].min() <= changed[0].max() < rows.max()
    assert (with_band[rows, 0] == 25).all()


def test_long_lines_stay_within_the_picture() -> None:
    for text in ("W" * 90, "W" * 300):
        picture = np.zeros((256, 192, 3), np.uint8)
        draw_overlay(picture, text, (text,))
        columns = np.flatnonzero(picture.any(axis=(0, 2)))
        assert columns.min() > 0
        assert columns.max() < 191


# ---------------------------------------------------------------- the window


class Stage:
    """A show that notes what it is told, and does something at each tick."""

    def __init__(self, *deeds: Callable[[], object]) -> None:
        self.ended = False
        self.told: list[Any] = []
        self._deeds = list(deeds)

    def press(self, key: Key) -> None:
        self.told.append(("press", key))

    def release(self, key: Key) -> None:
        self.told.append(("release", key))

    def point(self, x: float) -> None:
        self.told.append(("point", x))

    def leave(self) -> None:
        self.told.append("leave")

    def tick(self) -> None:
        if self._deeds:
            self._deeds.pop(0)()
        else:
            self.ended = True

    def picture(self) -> np.ndarray:
        return np.zeros((512, 384, 3), np.uint8)


def post(kind: str, **attributes: Any) -> Callable[[], object]:
    import pygame

    return lambda: pygame.event.post(pygame.event.Event(getattr(pygame, kind), **attributes))


def test_events_mean_keys_and_places() -> None:
    import pygame

    stage = Stage(
        post("KEYDOWN", key=pygame.K_a),
        post("KEYUP", key=pygame.K_a),
        post("KEYDOWN", key=pygame.K_q),
        post("MOUSEBUTTONDOWN", button=1),
        post("MOUSEBUTTONUP", button=1),
        post("MOUSEBUTTONDOWN", button=3),
        post("WINDOWFOCUSLOST"),
        post("KEYDOWN", key=pygame.K_ESCAPE),
        lambda: None,
    )
    assert not run_show(stage, "test", FAST)
    assert stage.told == [
        ("press", Key.LEFT),
        ("release", Key.LEFT),
        ("press", Key.FIRE),
        ("release", Key.FIRE),
        "leave",
        ("press", Key.QUIT),
    ]


@pytest.mark.parametrize("size", [(384, 512), (768, 1024), (1000, 512), (300, 900)])
def test_the_mouse_points_at_the_field_in_a_window_of_any_size(
    size: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    windows: list[Any] = []

    class Kept(show.Window):
        def __init__(self, *arguments: Any) -> None:
            super().__init__(*arguments)
            windows.append(self)

    monkeypatch.setattr(show, "Window", Kept)
    # Where the walls' inner edges and the middle lie, found in the window's proportions alone.
    factor = min(size[0] / 384, size[1] / 512)
    left = (size[0] - 384 * factor) / 2
    places = [left + factor * 384 * part for part in (0.5 / 12, 0.5, 11.5 / 12)]
    stage = Stage(
        lambda: setattr(windows[0]._window, "size", size),
        *(post("MOUSEMOTION", pos=(place, 10)) for place in places),
        lambda: None,
    )
    run_show(stage, "test", FAST)
    found = [x for told, x in stage.told if told == "point"]
    assert found == pytest.approx([0.0, 5.5, 11.0], abs=1.5 / factor / 32)


def test_f_fills_the_screen_and_does_not_concern_the_game(monkeypatch: pytest.MonkeyPatch) -> None:
    import pygame

    toggled: list[bool] = []
    monkeypatch.setattr(show.Window, "toggle_full_screen", lambda self: toggled.append(True))
    stage = Stage(post("KEYDOWN", key=pygame.K_f), post("KEYUP", key=pygame.K_f), lambda: None)
    run_show(stage, "test", FAST)
    assert toggled == [True]
    assert ("press", Key.FULL_SCREEN) not in stage.told


def test_a_window_fills_the_screen_and_becomes_a_window_again() -> None:
    window = show.Window("test", FAST)
    picture = np.full((64, 48, 3), 200, np.uint8)
    window.show(picture)
    for _ in range(4):
        window.toggle_full_screen()
        assert window.show(picture)
    window.close()


def test_closing_the_window_ends_the_show() -> None:
    stage = Stage(post("QUIT"), lambda: pytest.fail("the show goes on"))
    assert not run_show(stage, "test", FAST)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_the_show_between_two_pictures(number: signal.Signals) -> None:
    before = signal.getsignal(number)
    stage = Stage(
        lambda: signal.raise_signal(number), lambda: None, lambda: None, lambda: None, lambda: None
    )
    assert run_show(stage, "test", FAST)
    assert signal.getsignal(number) is before


def test_whatever_goes_wrong_the_window_is_closed_and_signals_are_as_before() -> None:
    before = signal.getsignal(signal.SIGINT)

    def fail() -> None:
        raise RuntimeError("the show is broken")

    with pytest.raises(RuntimeError, match="broken"):
        run_show(Stage(fail), "test", FAST)
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.parametrize(
    ("screen", "height"),
    [
        ((1920, 1080), 960),
        ((1366, 768), 672),
        ((2560, 1440), 1280),
        ((7680, 4320), 1440),
        ((500, 2000), 640),
        ((10, 10), HEIGHT_STEP),
    ],
)
def test_pictures_are_as_high_as_the_screen_allows(
    screen: tuple[int, int], height: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    import pygame

    monkeypatch.setattr(pygame.display, "get_desktop_sizes", lambda: [screen])
    assert screen_height() == height


# ---------------------------------------------------------------- a replay in the window


def test_a_viewer_shows_the_game_to_its_end_and_again(game: Replay) -> None:
    viewer = Viewer(game, 1.0, HEIGHT)
    assert viewer.frames_per_second == 60.0
    frames = []
    for _ in range(game.result.decisions + 1):
        frames.append(viewer.picture())
        viewer.tick()
    expected = [draw_world(b.worlds, b.rules, 0, HEIGHT) for b in replay_states(game)]
    np.testing.assert_array_equal(frames, expected)
    assert viewer.text()[0] == "THE END"
    assert f"SCORE {game.result.score}" in viewer.text()[1][0]
    tap(viewer, Key.FIRE)
    np.testing.assert_array_equal(viewer.picture(), expected[0])


def test_a_viewer_pauses_and_begins_again(game: Replay) -> None:
    viewer = Viewer(game, 1.0, HEIGHT)
    first = viewer.picture()
    for _ in range(100):
        viewer.tick()
    tap(viewer, Key.PAUSE)
    assert viewer.text()[0] == "PAUSED"
    paused = viewer.picture()
    viewer.tick()
    np.testing.assert_array_equal(viewer.picture(), paused)
    tap(viewer, Key.FIRE)
    viewer.tick()
    assert (viewer.picture() != paused).any()
    tap(viewer, Key.RESTART)
    np.testing.assert_array_equal(viewer.picture(), first)
    tap(viewer, Key.QUIT)
    assert viewer.ended


@pytest.mark.parametrize("speed", [0.25, 1.0, 1.5, 8.0])
def test_the_speed_is_the_one_asked_for(game: Replay, speed: float) -> None:
    viewer = Viewer(game, speed, HEIGHT)
    assert viewer.frames_per_second <= 60.0
    ticks = 0
    while not viewer.text()[0]:
        viewer.tick()
        ticks += 1
    seconds = ticks / viewer.frames_per_second
    assert seconds == pytest.approx(game.result.decisions / 60 / speed, rel=0.05)


# ---------------------------------------------------------------- the commands


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """No real time, and small pictures."""
    monkeypatch.setattr(play, "TICKS_PER_SECOND", FAST)
    monkeypatch.setattr(play, "screen_height", lambda: HEIGHT)


def after(ticks: int, deed: Callable[[Any], object]) -> Callable[[Any], None]:
    """A method `tick` that starts the game, and does something after so many ticks."""
    original = Sitting.tick

    def tick(self: Any) -> None:
        if self.phase is Phase.READY:
            tap(self, Key.FIRE)
        original(self)
        if self.world.decisions == ticks:
            deed(self)

    return tick


@pytest.mark.parametrize(
    ("deed", "status"),
    [
        (lambda sitting: sitting.press(Key.QUIT), 0),
        (lambda sitting: post("QUIT")(), 0),
        (lambda sitting: signal.raise_signal(signal.SIGINT), 130),
    ],
    ids=["escape", "window closed", "Ctrl-C"],
)
def test_playing_saves_a_replay_however_it_ends(
    deed: Callable[[Any], object],
    status: int,
    quick: None,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(Sitting, "tick", after(200, deed))
    path = tmp_path / "new folder" / "game.replay"
    arguments = ["play", "--level", "comb", "--seed", "3", "--lives", "5", "--save", str(path)]
    assert cli.main(arguments) == status
    assert f"arkanoid replay {path}" in capsys.readouterr().out
    replay = Replay.load(path)
    assert play_replay(replay).decisions >= 200
    assert (replay.config.lives, replay.config.frame_skip) == (5, 1)
    assert next(replay_states(replay)).worlds["round_number"][0] == 6


def test_an_exception_does_not_lose_the_game(
    quick: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def fail(sitting: Any) -> None:
        raise RuntimeError("broken")

    monkeypatch.setattr(Sitting, "tick", after(50, fail))
    path = tmp_path / "game.replay"
    with pytest.raises(RuntimeError, match="broken"):
        cli.main(["play", "--save", str(path)])
    assert play_replay(path).decisions == 50


def test_without_a_name_replays_are_dated_files_in_the_users_folder(
    quick: None,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    import platformdirs

    monkeypatch.setattr(platformdirs, "user_data_dir", lambda *_: str(tmp_path))
    monkeypatch.setattr(Sitting, "tick", after(30, lambda sitting: sitting.press(Key.QUIT)))
    for _ in range(2):
        assert cli.main(["play", "--lite"]) == 0
    printed = capsys.readouterr().out.splitlines()
    paths = [Path(line.rsplit(" ", 1)[1]) for line in printed]
    assert sorted(paths) == sorted((tmp_path / "replays").iterdir())
    assert len(set(paths)) == 2
    one, other = (Replay.load(path) for path in paths)
    assert not one.config.capsules
    assert not one.config.enemies
    assert one.start.random != other.start.random


def test_no_file_is_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "a.b.replay"
    for expected in ("a.b.replay", "a.b-2.replay", "a.b-3.replay"):
        free = free_path(path)
        assert free.name == expected
        free.write_text("")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--level", "spirol"], "Did you mean 'spiral'"),
        (["--level", "seed:x"], "as in seed:7"),
        (["--level", "warden", "--lite"], "has the boss"),
        (["--lives", "0"], "lives must be between 1 and 1000"),
        (["--speed", "nan"], "speed must be between"),
        (["--difficulty", "7"], "difficulty must be between 0 and 1"),
        (["--seed", "-1"], "seed must be between 0"),
    ],
)
def test_mistakes_in_playing(
    arguments: list[str], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.main(["play", "--save", str(tmp_path / "x.replay"), *arguments]) == 2
    message = capsys.readouterr().err
    assert message.startswith("arkanoid: error: ")
    assert message.count("\n") == 1
    assert words in message


def test_a_folder_that_cannot_be_made_is_noticed_before_the_game(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    assert cli.main(["play", "--save", str(tmp_path / "file" / "x.replay")]) == 2
    assert "choose another --save" in capsys.readouterr().err


def test_playing_needs_pygame_and_nothing_else_of_the_extras(tmp_path: Path) -> None:
    program = """
import sys
missing = sys.argv[1].split(",")
for name in missing:
    sys.modules[name] = None
from arkanoid.agents.cli import main
from arkanoid.envs.play import sitting
from arkanoid.envs.play.controls import Key
sitting.Sitting.tick = lambda self: self.press(Key.QUIT)
sys.exit(main(["play", "--save", sys.argv[2]]))
"""
    path = str(tmp_path / "x.replay")
    train = "torch,stable_baselines3,imageio,PIL,tqdm,rich,tensorboard"
    command = [sys.executable, "-c", program]
    run = subprocess.run([*command, train, path], capture_output=True, text=True)
    assert (run.returncode, run.stdout) == (0, ""), run.stderr
    run = subprocess.run([*command, "pygame", path], capture_output=True, text=True)
    assert run.returncode == 1
    assert 'pip install "arkanoid[play]"' in run.stderr
    assert "Traceback" not in run.stderr


def test_a_replay_is_verified(
    game: Replay, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "game.replay"
    game.save(path)
    assert cli.main(["replay", str(path), "--verify"]) == 0
    assert f"score {game.result.score}" in capsys.readouterr().out
    commands = game.commands.copy()
    commands[50:90, 0] = -commands[50:90, 0] + 0.5
    Replay(**(vars(game) | {"commands": commands.clip(-1.0, 1.0)})).save(path)
    for arguments in (["--verify"], ["--export", str(tmp_path / "x.png")]):
        assert cli.main(["replay", str(path), *arguments]) == 1
        assert f"error: {path}: the game " in capsys.readouterr().err


def test_the_last_picture_as_png(game: Replay, tmp_path: Path) -> None:
    game.save(tmp_path / "game.replay")
    export = ["replay", str(tmp_path / "game.replay"), "--export", str(tmp_path / "x.PNG")]
    assert cli.main(export) == 0
    *_, last = replay_frames(game)
    np.testing.assert_array_equal(iio.imread(tmp_path / "x.PNG"), last)
    assert cli.main([*export, "--to", "2", "--height", "64"]) == 0
    states = replay_states(game)
    for _ in range(121):
        batch = next(states)
    expected = draw_world(batch.worlds, batch.rules, 0, 64)
    np.testing.assert_array_equal(iio.imread(tmp_path / "x.PNG"), expected)


@pytest.mark.parametrize(("speed", "seconds"), [(1.0, 3.0), (3.0, 1.0), (0.5, 6.0)])
def test_a_film_as_gif(game: Replay, tmp_path: Path, speed: float, seconds: float) -> None:
    game.save(tmp_path / "game.replay")
    film = tmp_path / "x.gif"
    part = ["--from", "1", "--to", "4", "--height", "96", "--speed", str(speed)]
    assert cli.main(["replay", str(tmp_path / "game.replay"), "--export", str(film), *part]) == 0
    with Image.open(film) as clip:
        assert clip.size == (72, 96)
        lengths = []
        for index in range(clip.n_frames):
            clip.seek(index)
            lengths.append(clip.info["duration"])
            picture = np.asarray(clip.convert("RGB")).astype(float)
            if index == 0:
                first = picture
        # The last picture is shown for a while, too.
        assert sum(lengths) / 1000 == pytest.approx(seconds, abs=0.11)
    shown = replay_states(game)
    for _ in range(61):
        batch = next(shown)
    expected = draw_world(batch.worlds, batch.rules, 0, 96)
    assert abs(first - expected).mean() < 2.0


def test_a_film_as_mp4(game: Replay, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a stand-in for ffmpeg, which is large, and not needed for anything else."""
    calls: list[Any] = []
    frames: list[np.ndarray] = []

    def write_frames(path: Path, size: tuple[int, int], **keywords: Any) -> Iterator[None]:
        calls.append((path, size, keywords["fps"]))
        try:
            while True:
                frames.append((yield))
        finally:
            calls.append("closed")

    stand_in = SimpleNamespace(write_frames=write_frames)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", stand_in)
    game.save(tmp_path / "game.replay")
    film = tmp_path / "x.mp4"
    part = ["--to", "1", "--height", "101"]
    assert cli.main(["replay", str(tmp_path / "game.replay"), "--export", str(film), *part]) == 0
    assert calls == [(film, (76, 102), 60.0), "closed"]
    assert len(frames) == 61
    assert all(frame.shape == (102, 76, 3) for frame in frames)


def test_what_is_missing_for_films_is_said(
    game: Replay,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    game.save(tmp_path / "game.replay")
    replay = ["replay", str(tmp_path / "game.replay"), "--export"]
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    assert cli.main([*replay, str(tmp_path / "x.mp4")]) == 2
    assert "pip install imageio-ffmpeg" in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "PIL", None)
    assert cli.main([*replay, str(tmp_path / "x.gif")]) == 1
    assert 'pip install "arkanoid[train]"' in capsys.readouterr().err
    assert cli.main([*replay, str(tmp_path / "x.png")]) == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["no.replay"], "no.replay: No such file"),
        (["GAME", "--export", "x.avi"], "exports are .gif, .mp4 or .png"),
        (["GAME", "--export", "no/such/x.gif"], "no/such/x.gif: No such file"),
        (["GAME", "--export", "x.png", "--from", "999"], "the game lasts"),
        (["GAME", "--export", "x.png", "--height", "0"], "height must be between"),
        (["WRONG"], "this is no replay"),
    ],
)
def test_mistakes_with_replays(
    game: Replay,
    arguments: list[str],
    words: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    game.save("GAME")
    Path("WRONG").write_text("name: Mine\n", encoding="utf-8")
    assert cli.main(["replay", *arguments]) == 2
    message = capsys.readouterr().err
    assert message.startswith("arkanoid: error: ")
    assert message.count("\n") == 1
    assert words in message


@pytest.mark.parametrize("option", [["--speed", "0"], ["--speed", "nan"], ["--from", "-1"]])
def test_illegal_numbers_are_refused(option: list[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        cli.main(["replay", "x", *option])
    assert stop.value.code == 2


def test_a_replay_is_shown_in_a_window(
    game: Replay, quick: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    game.save(tmp_path / "game.replay")
    original = Viewer.tick
    ticks = []

    def tick(self: Any) -> None:
        original(self)
        ticks.append(1)
        if self.text()[0] == "THE END":
            self.press(Key.QUIT)

    monkeypatch.setattr(Viewer, "tick", tick)
    assert cli.main(["replay", str(tmp_path / "game.replay"), "--speed", "200"]) == 0
    assert len(ticks) == pytest.approx(game.result.decisions / 200, abs=2)
