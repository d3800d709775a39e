"""Replays in a real browser: its own, Python's, and files that are none."""

import base64
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arkanoid.agents.cli import main
from arkanoid.envs.batch.batch import Batch
from arkanoid.envs.batch.playback import play_replay
from arkanoid.envs.batch.recorder import Recorder
from arkanoid.envs.batch.replays import Replay
from arkanoid.envs.browser.manifest import browser_games
from arkanoid.envs.config import Config
from helpers.browser import wait_until
from helpers.repository import TESTS

DROP = """([name, text]) => {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const dataTransfer = new DataTransfer();
  dataTransfer.items.add(new File([bytes], name));
  document.body.dispatchEvent(new DragEvent("drop", { dataTransfer, bubbles: true }));
}"""
STATE = "Array.from(arkanoid.part.game.save())"


@pytest.fixture(scope="module")
def recorded() -> bytes:
    """A game that follows the ball, with some noise, recorded in Python."""
    batch = Batch(1, browser_games()["full"])
    recorder = Recorder(batch, 0)
    batch.reset(np.ones(1, np.bool_), {"level": "spiral"}, [3])
    luck = np.random.default_rng(1)
    (world,) = batch.worlds
    for _ in range(3000):
        if batch.worlds["done"][0]:
            break
        side = float(world["ball_x"][0] - world["paddle_x"]) + luck.uniform(-0.5, 0.5)
        batch.command(np.array([3 if abs(side) < 0.2 else 1 + (side > 0)]))
        batch.step()
    return recorder.replay().to_bytes()


def drop(page: Any, name: str, content: bytes) -> None:
    page.evaluate(DROP, [name, base64.b64encode(content).decode()])


def verdict(page: Any) -> str:
    wait_until(page, "document.getElementById('verdict')?.textContent")
    return page.locator("#verdict").text_content()


def test_a_game_of_the_page_plays_in_python(page: Any, tmp_path: Path) -> None:
    page.keyboard.press("Space")
    page.keyboard.down("ArrowRight")
    wait_until(page, "world.decisions > 90")
    page.keyboard.up("ArrowRight")
    page.keyboard.press("p")
    with page.expect_download() as download:
        page.get_by_role("button", name="Save replay").click()
    path = tmp_path / "mine.replay"
    download.value.save_as(path)
    assert main(["replay", str(path), "--verify"]) == 0
    assert play_replay(Replay.load(path)).decisions > 90
    assert (Replay.load(path).commands[:, 0] == 1).sum() > 60


def test_a_game_of_python_plays_in_the_page(page: Any, recorded: bytes) -> None:
    """Dropped anywhere, verified, and shown from any time on, with the same states."""
    drop(page, "python.replay", recorded)
    assert verdict(page).startswith("The same game: all ")
    page.keyboard.press("p")
    length = page.evaluate("arkanoid.part._replay.length")
    assert length == len(Replay.from_bytes(recorded).commands)
    states = {}
    page.evaluate("arkanoid.part._goTo(0)")
    for decision in (100, 256, 500, 511, length):
        page.evaluate(
            "(to) => { const { part } = arkanoid; while (part._at < to) part._step(); }", decision
        )
        states[decision] = page.evaluate(STATE)
    for decision in (500, length, 100, 511, 256):
        page.evaluate(
            """(to) => {
              const scrub = document.getElementById("scrub");
              scrub.value = to;
              scrub.dispatchEvent(new Event("input"));
            }""",
            decision,
        )
        assert page.evaluate("arkanoid.part._at") == decision
        assert page.evaluate(STATE) == states[decision]


def test_the_game_just_played(page: Any) -> None:
    page.keyboard.press("Space")
    wait_until(page, "world.decisions > 20")
    page.get_by_role("link", name="Replay").click()
    page.get_by_role("button", name="The game just played").click()
    assert verdict(page).startswith("The same game: all ")


def test_any_configuration_can_be_seen(page: Any) -> None:
    """The golden replay has capsules, enemies, more lives, and levels of its own."""
    drop(page, "golden.replay", (TESTS / "envs" / "batch" / "golden.replay").read_bytes())
    assert verdict(page).startswith("The same game: all ")


def test_a_paddle_of_another_width_is_refused(page: Any) -> None:
    batch = Batch(1, Config(paddle=2.0))
    recorder = Recorder(batch, 0)
    batch.reset(np.ones(1, np.bool_), {}, [3])
    drop(page, "wide.replay", recorder.replay().to_bytes())
    assert verdict(page) == "The paddle is 2 times as wide as the browser's."


def test_files_that_are_no_replays(page: Any, recorded: bytes) -> None:
    for content, sentence in {
        b"name: Mine\n\n...": "This is no replay.",
        recorded[:-1]: "The replay is damaged.",
        recorded[:200] + b"?" + recorded[201:]: "The replay is damaged.",
    }.items():
        page.evaluate("() => { document.getElementById('verdict').textContent = ''; }")
        drop(page, "some.replay", content)
        assert verdict(page) == sentence
    assert page.locator("#pause").is_disabled()
