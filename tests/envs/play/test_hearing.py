"""Which tones a tick has."""

from typing import Any

import numpy as np
from arkanoid.envs.batch.batch import Batch
from arkanoid.envs.config import Config
from arkanoid.envs.play.by_hand import BY_HAND
from arkanoid.envs.play.hearing import TONES, tones_of
from arkanoid.envs.play.sound import Tone
from arkanoid.envs.rules import PADDLE_TOP
from arkanoid.envs.state import FLYING, Outcome, World

COUNTED = {
    "lives_lost": Tone.LIFE_LOST,
    "rounds_cleared": Tone.CLEARED,
    "lives_gained": Tone.LIFE_WON,
    "capsules_caught": Tone.CAPSULE,
    "enemies_destroyed": Tone.ENEMY,
    "hits": Tone.BRICK,
}


def expected(before: Any, after: Any, outcome: Any) -> list[Tone]:
    """Return the tones by arrays: of what is counted, and of balls that have turned."""
    tones = [tone for field, tone in COUNTED.items() if outcome[field] > 0]
    flying = (before["ball_state"] == FLYING) & (after["ball_state"] == FLYING)
    turned_x = np.sign(before["ball_vx"]) != np.sign(after["ball_vx"])
    turned_y = np.sign(before["ball_vy"]) != np.sign(after["ball_vy"])
    low = (after["ball_y"] < PADDLE_TOP + 1.0) & (after["ball_vy"] > 0.0)
    if (flying & turned_y & low).any():
        return [*tones, Tone.PADDLE]
    return tones or [Tone.WALL] * bool((flying & (turned_x | turned_y)).any())


def test_the_tones_of_games() -> None:
    """All of them are heard in a minute of four games but for a round's end and a life won."""
    batch = Batch(1, Config(**{**BY_HAND, "lives": 9}))
    heard = set()
    for seed in range(4):
        batch.reset(np.ones(1, np.bool_), None, [seed])
        for _ in range(3600):
            before = batch.worlds[0].copy()
            way = np.clip(before["ball_x"][0] - before["paddle_x"], -1.0, 1.0)
            batch.command(np.array([[way, 1.0]], np.float32))
            batch.step()
            tones = tones_of(before, batch.worlds[0], batch.outcomes[0])
            assert tones == expected(before, batch.worlds[0], batch.outcomes[0])
            heard |= set(tones)
    assert heard >= set(Tone) - {Tone.CLEARED, Tone.LIFE_WON, Tone.LIFE_LOST}


def test_the_loudest_comes_first() -> None:
    before, after = np.zeros(1, World), np.zeros(1, World)
    before["ball_state"] = after["ball_state"] = FLYING
    after["ball_vx"] = 1.0
    outcome = np.zeros(1, Outcome)
    assert tones_of(before[0], after[0], outcome[0]) == [Tone.WALL]
    for field in COUNTED:
        outcome[field] = 1
    assert tones_of(before[0], after[0], outcome[0]) == list(COUNTED.values())
    after["ball_vy"] = 1.0
    assert tones_of(before[0], after[0], outcome[0]) == list(TONES[:-1])
