"""Replays in a real browser: its own, Python's, and files that are none."""

import base64
import json
import struct
import zlib
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
from arkanoid.envs.rules import RULES_VERSION
from arkanoid.physics.kernels.sealed import seal
from helpers.browser import pass_time, wait_until
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
    before = page.evaluate("arkanoid.part.game.world.decisions")
    wait_until(page, f"world.decisions > {before + 90}")
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
    page.evaluate("arkanoid.part.leave()")  # it pauses
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


def test_a_game_without_a_decision(page: Any) -> None:
    """It was played on, and from then on no picture was shown."""
    batch = Batch(1, browser_games()["full"])
    recorder = Recorder(batch, 0)
    batch.reset(np.ones(1, np.bool_), {}, [3])
    drop(page, "empty.replay", recorder.replay().to_bytes())
    wait_until(page, "part.phase === 'over'")
    assert verdict(page).startswith("The same game: all ")
    page.keyboard.press("Space")
    page.keyboard.press("ArrowRight")
    page.keyboard.press(".")
    wait_until(page, "!arkanoid.stage.stale")


def test_the_file_that_was_dropped_last_is_shown(page: Any, recorded: bytes) -> None:
    """A larger one, dropped before, took its place as soon as it was read."""
    page.evaluate("""() => {
      const { arrayBuffer: read } = File.prototype;
      const { promise, resolve } = Promise.withResolvers();
      globalThis.goOn = resolve;
      File.prototype.arrayBuffer = async function () {
        if (this.name !== "last.replay") await promise;
        return read.call(this);
      };
    }""")
    for name, content in {"none": b"", "first": recorded, "last": recorded}.items():
        drop(page, f"{name}.replay", content)
    assert verdict(page).startswith("The same game: all ")
    page.evaluate("goOn()")
    pass_time(page, 100)
    assert verdict(page).startswith("The same game: all ")
    assert page.locator("#replay-name").text_content() == "last.replay"


def test_a_file_before_there_is_a_place_for_it(page: Any, recorded: bytes) -> None:
    """A second one, dropped while replays were being opened, was called damaged."""
    page.evaluate("""() => {
      const { arkanoid: kernels } = arkanoid;
      const open = kernels.open.bind(kernels);
      const { promise, resolve } = Promise.withResolvers();
      globalThis.goOn = resolve;
      kernels.open = async (...given) => { await promise; return open(...given); };
    }""")
    for name in ("first.replay", "second.replay"):
        drop(page, name, recorded)
    page.evaluate("goOn()")
    assert verdict(page).startswith("The same game: all ")


def test_any_configuration_can_be_seen(page: Any) -> None:
    """The golden replay has capsules, enemies, more lives, and levels of its own."""
    drop(page, "golden.replay", (TESTS / "envs" / "batch" / "golden.replay").read_bytes())
    assert verdict(page).startswith("The same game: all ")


def test_a_paddle_of_another_width(page: Any) -> None:
    """Its shape was known for the width of the page's own games only."""
    batch = Batch(1, Config(paddle=2.3, actions="box"))
    recorder = Recorder(batch, 0)
    batch.reset(np.ones(1, np.bool_), {}, [3])
    moves = np.random.default_rng(3).uniform(-1.0, 1.0, (600, 1, 2)).astype(np.float32)
    for move in moves:
        if not recorder.over:
            batch.command(move)
            batch.step()
    drop(page, "wide.replay", recorder.replay().to_bytes())
    assert verdict(page).startswith("The same game: all ")
    half = page.evaluate("arkanoid.part.game.world.paddle_half")
    assert half in (batch.rules["paddle_half"][0], batch.rules["long_paddle_half"][0])


def _with_head(head: dict[str, Any]) -> bytes:
    """Return a file whose checksum is right, and whose JSON is this."""
    text = zlib.compress(json.dumps(head).encode())
    return seal(b"ARKAPLAY", 1, struct.pack("<I", len(text)) + text)


def test_files_that_are_no_replays(page: Any, recorded: bytes) -> None:
    for content, sentence in {
        b"name: Mine\n\n...": "This is no replay.",
        b"": "This is no replay.",
        b"\x89PNG\r\n\x1a\n" + bytes(99): "This is no replay.",
        seal(b"ARKAPLAY", 2, b""): "The replay is of another format.",
        _with_head({}): "The replay is damaged.",
        _with_head({"rules": 99}): "The replay is of version 99 of the rules.",
        _with_head({"rules": RULES_VERSION}): "The replay is damaged.",
        seal(b"ARKAPLAY", 1, bytes(9)): "The replay is damaged.",
        recorded[:-1]: "The replay is damaged.",
        recorded[:200] + b"?" + recorded[201:]: "The replay is damaged.",
    }.items():
        page.evaluate("() => { document.getElementById('verdict').textContent = ''; }")
        drop(page, "some.replay", content)
        assert verdict(page) == sentence
    assert page.locator("#pause").is_disabled()
