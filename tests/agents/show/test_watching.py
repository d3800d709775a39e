"""The keys of `arkanoid watch`."""

import numpy as np
import pytest
from arkanoid.agents.experiment.settings import load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.measure.baselines import make_baseline
from arkanoid.agents.measure.suites import WHOLE_GAMES
from arkanoid.agents.show.frames import Frame, play_frames
from arkanoid.agents.show.watching import Watching
from arkanoid.envs.play.controls import Key

EXPERIMENT = load_experiment("quick", [("env.max_decisions", "30")])


@pytest.fixture
def reports() -> list[int]:
    return []


@pytest.fixture
def watching(reports: list[int]) -> Watching:
    policy = make_baseline("no-op", make_worlds(EXPERIMENT, 1), 0)

    def report(game: int, frame: Frame) -> None:
        reports.append(game)

    return Watching(EXPERIMENT, policy, (WHOLE_GAMES,), report)


def test_games_follow_each_other(watching: Watching, reports: list[int]) -> None:
    while len(reports) < 3:
        watching.tick()
    assert reports == [1, 2, 3]


def test_the_keys_are_shown_first_and_then_the_game(watching: Watching) -> None:
    policy = make_baseline("no-op", make_worlds(EXPERIMENT, 1), 0)
    expected = next(play_frames(EXPERIMENT, policy, smooth=True)).picture
    assert (watching.picture() != expected).any()
    watching.press(Key.PAUSE)
    for _ in range(300):
        watching.picture()
    watching.press(Key.PAUSE)
    np.testing.assert_array_equal(watching.picture(), expected)


def test_keys_pause_go_to_the_next_game_and_back_and_quit(watching: Watching) -> None:
    first = watching._frame.picture
    for _ in range(40):
        watching.tick()
    watching.press(Key.FIRE)
    held = watching._frame.picture
    watching.tick()
    np.testing.assert_array_equal(watching._frame.picture, held)
    assert watching.text()[0] == "PAUSED"
    watching.press(Key.RESTART)
    assert not watching.paused
    np.testing.assert_array_equal(watching._frame.picture, first)
    watching.press(Key.NEXT)
    assert watching._game == 1
    watching.press(Key.FASTER)
    watching.press(Key.FASTER)
    assert watching._pace.stride * watching.frames_per_second == pytest.approx(240.0)
    assert watching.text() == ("", ("SPEED 4",))
    watching.press(Key.QUIT)
    assert watching.ended
