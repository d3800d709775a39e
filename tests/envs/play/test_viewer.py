"""A recorded game that is shown."""

import numpy as np
import pytest
from arkanoid.envs.batch.playback import replay_states
from arkanoid.envs.batch.replays import Replay
from arkanoid.envs.draw.picture import draw_world
from arkanoid.envs.play.controls import Key
from arkanoid.envs.play.viewer import HINT_SECONDS, Viewer
from helpers.sittings import HEIGHT, tap


def test_a_viewer_shows_the_game_to_its_end_and_again(game: Replay) -> None:
    viewer = Viewer(game, 1.0, HEIGHT)
    viewer._hints = 0
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
    viewer._hints = 0
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


def test_two_keys_change_the_speed(game: Replay) -> None:
    """Without them, a replay had to be started again for another speed."""
    viewer = Viewer(game, 1.0, HEIGHT)
    for key, speed in ((Key.FASTER, 2.0), (Key.FASTER, 4.0), (Key.SLOWER, 2.0), (Key.SLOWER, 1.0)):
        tap(viewer, key)
        assert viewer.text() == ("", (f"SPEED {speed:g}",))
        # Decisions per picture times pictures per second.
        assert viewer._pace.stride * viewer.frames_per_second == pytest.approx(60.0 * speed)
        assert viewer.frames_per_second <= 60.0
    for _ in range(60):
        viewer.text()
    assert not viewer.text()[1][0].startswith("SPEED")
    for _ in range(40):
        tap(viewer, Key.SLOWER)
    assert viewer.frames_per_second == pytest.approx(60.0 / 1000.0)


def test_it_shows_the_keys_at_first(game: Replay) -> None:
    """`watch` told them, and `replay`, which looks the same, only in its title."""
    viewer = Viewer(game, 1.0, HEIGHT)
    assert "ESC: QUIT" in viewer.text()[1][-1]
    for _ in range(round(HINT_SECONDS * viewer.frames_per_second)):
        viewer.picture()
    assert viewer.text() == ("", ())
