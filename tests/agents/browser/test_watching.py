"""Watching agents in a real browser, and the command that serves the page."""

import os
import shlex
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.error import HTTPError
from urllib.request import urlopen

import pytest
from arkanoid.agents.browser import page as page_module
from arkanoid.agents.cli import main
from arkanoid.agents.experiment.runs import ModelFile
from arkanoid.agents.show.page import as_html
from arkanoid.agents.show.report import show_alive
from arkanoid.envs.browser import shipped
from helpers.browser import DESKTOP, open_page, visit, wait_until
from helpers.processes import ARKANOID, PATIENCE, wait_for
from helpers.runs import facts_with, packaged_copy, sentence

# A whole game, decision by decision and tick by tick: what it looks like in the end.
BOTH_WAYS = """async (name) => {
  const { part } = arkanoid;
  const seen = ({ world }) => [world.score, world.round_number, world.lives, world.paddle_x,
    ...world.ball_x, ...world.ball_y, ...world.brick_hits];
  part.phase = "paused";
  const { Agent } = await import("arkanoid/network");
  const { bytesOf } = await import("arkanoid/data");
  const agent = new Agent(await arkanoid.arkanoid.open(name), await bytesOf(`agent-${name}`));
  part.game.reset({ seed: 3 });
  agent.game.reset({ seed: 3 });
  part._judgement = null;
  part.phase = "playing";
  let decisions = 0;
  for (; decisions < 1500 && !agent.game.over; decisions += 1) {
    agent.game.step(agent.judge().action);
    for (let tick = 0; tick < agent.config.frame_skip && !part.game.over; tick += 1) part.tick();
  }
  return [decisions, seen(agent.game), seen(part.game)];
}"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("page")


@pytest.fixture(scope="module")
def address(folder: Path) -> Iterator[str]:
    """The page as the command serves it."""
    process = subprocess.Popen(
        [*ARKANOID, "web", "--no-open"], stdout=subprocess.PIPE, text=True, cwd=folder
    )
    assert process.stdout is not None
    yield process.stdout.readline().split()[0]
    process.send_signal(signal.SIGTERM if os.name == "nt" else signal.SIGINT)
    process.communicate(timeout=PATIENCE)
    assert os.name == "nt" or process.returncode == 0  # nothing went wrong


@pytest.fixture
def page(browser: Any, address: str) -> Iterator[Any]:
    with visit(browser, f"{address}#watch", **DESKTOP) as page:
        yield page


def test_only_the_page_is_served(address: str) -> None:
    with urlopen(address) as answer:
        assert answer.read().startswith(b"<!doctype html>")
    with pytest.raises(HTTPError, match="404"):
        urlopen(f"{address}etc/passwd")


def test_a_browser_that_keeps_the_command_waiting(tmp_path: Path) -> None:
    """Those for terminals do. The page was served only when they had given up."""
    script, loaded = tmp_path / "browser.py", tmp_path / "loaded.html"
    script.write_text(
        "import sys, pathlib, urllib.request as request\n"
        f"page = request.urlopen(sys.argv[1], timeout={PATIENCE}).read()\n"
        f"pathlib.Path({str(loaded)!r}).write_bytes(page)\n",
        encoding="utf-8",
    )
    process = subprocess.Popen(
        [*ARKANOID, "web"],
        stdout=subprocess.PIPE,
        env=os.environ | {"BROWSER": shlex.join([sys.executable, str(script), "%s"])},
    )
    try:
        wait_for(loaded.exists)
    finally:
        process.kill()
        process.communicate()


@pytest.mark.parametrize("name", ["full", "lite"])
def test_an_agent_plays_tick_by_tick_as_it_was_trained(page: Any, name: str) -> None:
    page.get_by_label(name, exact=True).check()
    wait_until(page, f"part.game?.name === '{name} at play'")
    wait_until(page, "part.phase === 'playing'")
    decisions, trained, shown = page.evaluate(BOTH_WAYS, name)
    assert decisions > 100
    assert trained == shown


def test_what_an_agent_thinks_and_sees(page: Any) -> None:
    wait_until(page, "world.decisions > 60")
    page.keyboard.press("p")
    shares = page.locator("#chances b").all_text_contents()
    assert len(shares) == 6
    assert 97 <= sum(int(share.removesuffix(" %")) for share in shares) <= 103
    assert float(page.locator("#value").text_content()) != 0.0
    page.locator("#seen summary").click()
    parts = "document.querySelectorAll('.seen div').length"
    wait_until(page, f"{parts} === Object.keys(game.parts.vector).length")
    page.get_by_text("The field as planes").click()
    planes = "document.querySelectorAll('#planes figure').length"
    wait_until(page, f"{planes} === game.shapes.grid[0]")


def test_the_paddle_is_taken_and_handed_back(page: Any) -> None:
    button = page.locator("[data-do=hand]")
    wait_until(page, "world.decisions > 0")
    page.keyboard.down("ArrowLeft")
    assert button.text_content() == "Hand back"
    wait_until(page, "world.paddle_x - world.paddle_half < 0.01")
    page.keyboard.up("ArrowLeft")
    page.keyboard.press("t")
    assert button.text_content() == "Take over"
    picture = page.locator("#picture").bounding_box()
    page.mouse.click(picture["x"] + 20, picture["y"] + 300)
    assert button.text_content() == "Hand back"
    button.click()
    assert button.text_content() == "Take over"


def test_reduced_motion_waits_for_its_user(browser: Any, address: str) -> None:
    with visit(browser, f"{address}#watch", **DESKTOP, reduced_motion="reduce") as page:
        assert page.evaluate("[arkanoid.part.phase, arkanoid.part.game.world.decisions]") == [
            "paused",
            0,
        ]


def test_ones_own_agent(browser: Any, folder: Path) -> None:
    """It has the settings and the name of its run, and is shown first."""
    run = packaged_copy(folder / "mine")
    config = run.path / "config.toml"
    text = config.read_text(encoding="utf-8")
    config.write_text(text.replace('name = "lite"', 'name = "mine"'), encoding="utf-8")
    shutil.rmtree(folder / "out", ignore_errors=True)
    file = folder / "own.html"
    assert main(["web", "--model", str(run.path), "--out", str(file)]) == 0
    with visit(browser, f"{file.as_uri()}#watch", **DESKTOP) as page:
        wait_until(page, "world.decisions > 8")
        assert page.evaluate("arkanoid.part._agent.name") == "mine"
        names = page.locator("#panel-watch .choice label").all_text_contents()
        assert names == ["mine", "full", "lite"]


def test_a_report_shows_its_agent_at_play(browser: Any, folder: Path) -> None:
    """It stands in a frame, whose scripts can reach nothing else."""
    file = folder / "report.html"
    alive = show_alive(ModelFile.find("lite", False), [])
    report = as_html(facts_with("lite"), {"x.png": b"", "play.gif": b""}, alive)
    file.write_text(report, encoding="utf-8")
    faults: list[str] = []
    with open_page(browser) as page:
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.goto(file.as_uri())
        # What nobody sees stands still.
        page.locator("iframe").scroll_into_view_if_needed()
        inside = page.frame_locator("iframe")
        inside.locator("#chances .chosen").wait_for()
        assert inside.locator("#panel-watch .choice label").all_text_contents() == ["lite"]
        inside.get_by_role("button", name="Take over").click()
        inside.get_by_role("button", name="Hand back").wait_for()
    assert faults == []


def test_a_port_that_is_taken(address: str, capsys: pytest.CaptureFixture[str]) -> None:
    port = address.rstrip("/").rpartition(":")[2]
    assert main(["web", "--no-open", "--port", port]) == 2
    assert f"127.0.0.1:{port} cannot be served" in capsys.readouterr().err


def test_without_a_linker_there_is_a_sentence(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """Where the module did not come with the package and cannot be made."""

    def fail() -> bytes:
        raise ImportError("to make the game for browsers needs the linker wasm-ld")

    monkeypatch.setattr(page_module, "game_module", fail)
    assert main(["web", "--out", str(tmp_path / "game.html")]) == 2
    assert "needs the linker wasm-ld" in capsys.readouterr().err
    # A report only lacks the agent at play.
    assert show_alive(ModelFile.find("lite", False), []) == ""


@pytest.mark.parametrize("call", [["web"], ["web", "--out", "game.html"], ["watch", "--web"]])
def test_that_there_is_no_linker_is_said_at_once(
    call: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """All was compiled before, for ten seconds or more; so it was for a report."""

    def compile_() -> bytes:
        raise AssertionError

    monkeypatch.setattr(page_module, "game_module", compile_)
    monkeypatch.setattr(shipped, "offers_module", lambda: False)
    error = sentence(call, capsys)
    assert "linker wasm-ld" in error
    assert 'pip install -e ".[web]"' in error
    assert show_alive(ModelFile.find("lite", False), []) == ""
