"""A sitting: one game after another, pauses, titles, and which games are kept."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from arkanoid.envs.batch.playback import play_replay
from arkanoid.envs.batch.replays import Replay
from arkanoid.envs.play.controls import Key
from arkanoid.envs.play.gallery import load_or_generate
from arkanoid.envs.play.sitting import OVER_TICKS, TITLE_TICKS, WARNING_TICKS, Phase, Sitting
from arkanoid.envs.rules import IDLE_TICKS
from helpers.sittings import HEIGHT, lose, play_on, sit_down, tap


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


@pytest.mark.parametrize("pause", [lambda s: tap(s, Key.PAUSE), Sitting.lose_focus])
@pytest.mark.parametrize("back", [Key.PAUSE, Key.FIRE])
def test_in_a_pause_nothing_moves(pause: Callable[[Sitting], None], back: Key) -> None:
    sitting = sit_down()
    tap(sitting, Key.FIRE)
    sitting.press(Key.LEFT)
    for _ in range(20):
        sitting.tick()
    pause(sitting)
    assert sitting.text()[0] == "PAUSED"
    before = sitting.world.tobytes()
    for _ in range(20):
        sitting.tick()
    assert sitting.world.tobytes() == before
    tap(sitting, back)
    assert sitting.phase is Phase.PLAYING
    sitting.tick()
    # Keys that were held before the pause do not count: their release may have gone unseen.
    assert sitting.world.paddle_vx == 0.0
    assert sitting.world.decisions == 21


def test_losing_the_focus_before_a_game_changes_nothing() -> None:
    sitting = sit_down()
    sitting.lose_focus()
    tap(sitting, Key.PAUSE)
    assert sitting.phase is Phase.READY


def test_a_finished_game_is_kept_and_plays_again_bit_for_bit() -> None:
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


def test_a_player_who_hammers_the_button_still_sees_the_end() -> None:
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


def test_a_game_without_a_tick_is_not_kept() -> None:
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


def test_a_new_round_shows_its_name() -> None:
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


def test_a_player_is_warned_before_idling_costs_a_life() -> None:
    sitting = sit_down("warden")
    tap(sitting, Key.FIRE)
    sitting.world.idle = IDLE_TICKS - WARNING_TICKS - 1
    # The ball lies on the paddle during all of this.
    sitting.tick()
    assert sitting.text()[1] == ("HIT A BRICK WITHIN 15 S",)
    sitting.world.idle = IDLE_TICKS - 2
    sitting.tick()
    assert sitting.text()[1] == ("HIT A BRICK WITHIN 1 S",)
    sitting.tick()
    assert (sitting.world.lives, sitting.world.idle) == (2, 0)
    assert (sitting.phase, sitting.text()) == (Phase.PLAYING, ("", ()))


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


def test_a_generated_level_is_the_same_as_in_the_gallery() -> None:
    for difficulty in (None, 0.9):
        expected = load_or_generate("seed:12", 0.5 if difficulty is None else difficulty)
        sitting = sit_down("seed:12", difficulty=difficulty)
        for _ in range(3):
            np.testing.assert_array_equal(sitting.world.kind, expected.kinds.ravel())
            tap(sitting, Key.NEXT)


def test_a_level_of_ones_own_may_have_any_name(tmp_path: Path) -> None:
    file = tmp_path / "mine.txt"
    file.write_text("name: Straße Nr. 7 – für Zoë\n\n.w.......X.\n", encoding="utf-8")
    sitting = sit_down(str(file))
    assert sitting.text()[0] == "Straße Nr. 7 – für Zoë"
    assert sitting.picture().shape == (HEIGHT, 48, 3)
    with pytest.raises(ValueError, match="Did you mean 'spiral'"):
        sit_down("spirol")
    with pytest.raises(ValueError, match="'warden' has the boss"):
        sit_down("warden", enemies=False)
