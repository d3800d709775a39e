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
from arkanoid.envs.play.sound import Tone
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


@pytest.mark.parametrize("key", [Key.RESTART, Key.NEXT])
@pytest.mark.parametrize("no", [Key.FIRE, Key.PAUSE])
def test_a_key_that_drops_the_game_asks_first(key: Key, no: Key) -> None:
    """R and N are near other keys, and dropped a game without a question."""
    sitting = sit_down()
    tap(sitting, Key.FIRE)
    play_on(sitting, 50)
    before = sitting.world.tobytes()
    tap(sitting, key)
    assert sitting.phase is Phase.ASKED
    assert sitting.text()[0].endswith("?")
    sitting.tick()
    assert sitting.world.tobytes() == before
    tap(sitting, no)
    assert sitting.phase is Phase.PLAYING
    # The other key asks its own question: two different keys are no answer.
    tap(sitting, key)
    tap(sitting, Key.NEXT if key is Key.RESTART else Key.RESTART)
    assert (sitting.phase, sitting.world.tobytes()) == (Phase.ASKED, before)


def test_the_help_card_covers_a_game_that_waits() -> None:
    sitting = sit_down()
    tap(sitting, Key.FIRE)
    play_on(sitting, 50)
    before, picture = sitting.world.tobytes(), sitting.picture()
    tap(sitting, Key.HELP)
    card = sitting.picture()
    assert (card != picture).any()
    sitting.tick()
    assert (sitting.phase, sitting.world.tobytes()) == (Phase.PAUSED, before)
    # A key that puts the card away does nothing else.
    for key in (Key.HELP, Key.FIRE, Key.RESTART):
        tap(sitting, key)
        assert sitting.phase is Phase.PAUSED
        assert (sitting.picture() != card).any()
        tap(sitting, Key.HELP)
        np.testing.assert_array_equal(sitting.picture(), card)


def test_high_scores_are_of_games_that_can_be_compared() -> None:
    sitting = sit_down("comb", lives=1)
    assert not any("HIGH SCORE" in line for line in sitting.text()[1])
    results = []
    for _ in range(2):
        tap(sitting, Key.FIRE)
        play_on(sitting, 400)
        lose(sitting)
        results.append(int(sitting.world.score))
        for _ in range(OVER_TICKS):
            sitting.tick()
        places = [line for line in sitting.text()[1] if " 1. " in line]
        assert len(places) == 1
        assert str(max(results)) in places[0]
        tap(sitting, Key.FIRE)
        assert f"HIGH SCORE {max(results)}" in sitting.text()[1]
    # A game that begins with another round has scores of its own.
    tap(sitting, Key.NEXT)
    assert not any("HIGH SCORE" in line for line in sitting.text()[1])


def test_what_happens_is_heard() -> None:
    sitting = sit_down(lives=1)
    tap(sitting, Key.FIRE)
    play_on(sitting, 600)
    heard = sitting._speaker.heard
    assert {Tone.PADDLE, Tone.BRICK, Tone.WALL} <= set(heard)
    broken = 106 - int(sitting.world.bricks_left)
    assert 0 < heard.count(Tone.BRICK) <= broken
    assert Tone.LIFE_LOST not in heard
    lose(sitting)
    assert heard.count(Tone.LIFE_LOST) == 1
    tap(sitting, Key.SOUND)
    assert sitting.text()[0] == "GAME OVER"
    assert sitting.text()[1][0] == "SOUND ON"
