"""A run that is followed in a real browser, while it is trained."""

import contextlib
import os
import re
import shlex
import shutil
import signal
import subprocess
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from arkanoid.agents.cli import main
from arkanoid.agents.commands import web
from arkanoid.agents.experiment.runs import RunFolder
from arkanoid.agents.learn.training import train
from helpers.browser import DESKTOP, PHONE, open_page, visit, wait_until
from helpers.processes import PATIENCE, start_arkanoid
from helpers.runs import SMALL, small

ASKS = ("run.json", "agent")
NEWS = "arkanoid.following.news"
# Games that last, and a training that goes on for as long as the test.
LASTING = {
    **{"env.max_decisions": "20000", "env.lives": "9", "training.timesteps": "500_000_000"},
    "training.checkpoint_every": "2048",
}


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    experiment = small(tmp_path_factory.mktemp("finished"), **{"env.max_decisions": "20000"})
    run = RunFolder.create(experiment)
    train(experiment, run)
    return run


@contextlib.contextmanager
def started(*arguments: str | Path) -> Iterator[subprocess.Popen[str]]:
    """Start a command, and kill it in the end."""
    process = start_arkanoid(*arguments)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def printed(process: subprocess.Popen[str], form: str) -> str:
    """Return what a command prints in a line of a form."""
    assert process.stdout is not None
    for line in process.stdout:
        found = re.search(form, line)
        if found:
            return found[1]
    raise AssertionError(process.communicate())


@contextlib.contextmanager
def served(run: RunFolder) -> Iterator[Any]:
    """Serve the page of a run; yield the server."""
    page, followed = web.make(web.Wanted(str(run.path), trust=False), served=True)
    with web.open_server(page, 0, followed) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()


@pytest.mark.skipif(os.name == "nt", reason="Ctrl-C cannot be sent to one process alone")
def test_a_training_is_followed(browser: Any, tmp_path: Path) -> None:
    """By the command that it prints: curves and agent are renewed, and its end is told."""
    settings = {**SMALL, **LASTING, "output": str(tmp_path)}
    words = [word for key, value in settings.items() for word in (f"--{key}", value)]
    with started("train", "quick", *words) as training:
        follow = shlex.split(printed(training, "^follow +(.*)$"))
        follow = follow[follow.index("watch") :]
        assert follow[2:] == ["--web"]
        folder = Path(follow[1])
        with (
            started(*follow, "--no-open") as serving,
            visit(browser, printed(serving, "^(http[^ ]*)"), ASKS, **DESKTOP) as page,
        ):
            _follows(page, folder, training)
            with started("train", "--resume", folder):
                wait_until(page, f"{NEWS}.state === 'training'")
            # It was killed.
            wait_until(page, f"{NEWS}.state === 'stopped'")
            shutil.rmtree(folder)
            wait_until(page, f"{NEWS}.said.endsWith('is gone.')")
            plays_on(page)


def plays_on(page: Any) -> None:
    """Wait for further decisions, of this game or of the next one."""
    before = page.evaluate("arkanoid.part.game.world.decisions")
    wait_until(page, f"world.decisions !== {before}")


def _follows(page: Any, folder: Path, training: subprocess.Popen[str]) -> None:
    wait_until(page, f"{NEWS}.state === 'training' && part.phase === 'playing'")
    wait_until(page, "document.querySelectorAll('.curves figure').length >= 3")
    said = page.locator("[data-run=said]")
    assert re.fullmatch(r"Training: \d+ %, .* left\.", said.text_content())
    # A new agent plays on, in the same game. If that ends before, the next one is waited for.
    page.evaluate("() => { globalThis.known = {}; }")
    same = "(part._turn === known._turn || (Object.assign(known, part), false))"
    goes_on = "world.decisions > known._agent.game.world.decisions"
    wait_until(page, f"{same} && part._agent !== known._agent && {goes_on}")
    training.send_signal(signal.SIGINT)
    assert training.wait(PATIENCE) == 130
    wait_until(page, f"{NEWS}.said.startsWith('Stopped at ')")
    assert RunFolder(folder).read_notes()["outcome"] == "interrupted"


def test_a_run_without_an_agent_waits_for_one(browser: Any, tmp_path: Path) -> None:
    experiment = small(tmp_path, **{"env.max_decisions": "20000"})
    run = RunFolder.create(experiment)
    with served(run) as server, visit(browser, server.address, ASKS, **DESKTOP) as page:
        wait_until(page, "part.phase === 'waiting'")
        page.get_by_role("heading", name="No agent").wait_for()
        for key in ("Space", "t", ".", "ArrowLeft", "p"):
            page.keyboard.press(key)
            assert page.evaluate("arkanoid.part.phase") == "waiting"
        page.keyboard.press("n")
        wait_until(page, "part.phase === 'waiting'")
        assert page.locator("[data-do=hand]").is_disabled()
        # Another one plays meanwhile.
        page.get_by_label("lite", exact=True).check()
        wait_until(page, "part.phase === 'playing' && world.decisions > 0")
        page.get_by_label("quick", exact=True).check()
        wait_until(page, "part.phase === 'waiting'")
        train(experiment, run)
        wait_until(page, "part.phase === 'playing' && world.decisions > 0")
        page.get_by_text("Finished.", exact=True).wait_for()
        page.get_by_role("link", name="Editor").click()
        page.get_by_role("button", name="Let quick try 20 times").click()
        wait_until(page, "/^Cleared .* of 20/.test(document.getElementById('tries').textContent)")


def test_a_server_that_has_ended(browser: Any, finished: RunFolder, tmp_path: Path) -> None:
    """The page says so, and the agent plays on."""
    run = RunFolder(Path(shutil.copytree(finished.path, tmp_path / "run")))
    run.add_notes(outcome="interrupted")
    with open_page(browser) as page:
        with served(run) as server:
            page.goto(server.address)
            wait_until(page, "part?.phase === 'playing'")
        wait_until(page, f"{NEWS}.state === 'lost'")
        page.get_by_text("The command that served this page has ended.").wait_for()
        assert page.locator(".curves figure").count() == 3
        plays_on(page)


def test_one_file_shows_the_curves_as_they_are(
    browser: Any, finished: RunFolder, tmp_path: Path
) -> None:
    file = tmp_path / "page.html"
    assert main(["web", "--model", str(finished.path), "--out", str(file)]) == 0
    with visit(browser, file.as_uri(), **DESKTOP) as page:
        wait_until(page, "part.phase === 'playing'")
        first = page.locator(".curves figure").first
        assert "return, training" in first.text_content()
        picture = first.locator("svg").bounding_box()
        page.mouse.move(picture["x"] + picture["width"] / 2, picture["y"] + 10)
        assert " at " in first.locator("b").text_content()
        page.mouse.move(0, 0)
        assert " at " not in first.locator("b").text_content()
    with visit(browser, file.as_uri(), **PHONE) as page:
        wait_until(page, "part.phase === 'playing'")
        assert page.evaluate("document.documentElement.scrollWidth") == 390


def test_levels_that_are_asked_for_come_in_turn(browser: Any) -> None:
    with (
        started("watch", "lite", "--web", "--no-open", "--level", "seeds:5-6") as serving,
        visit(browser, printed(serving, "^(http[^ ]*)"), **DESKTOP) as page,
    ):
        wait_until(page, "part.phase === 'playing' && world.start_seed === 5")
        assert page.locator("#training").is_hidden()
        assert page.get_by_label("Level").input_value() == "asked"
        page.keyboard.press("n")
        wait_until(page, "part.phase === 'playing' && world.start_seed === 6")
        page.keyboard.press("r")
        wait_until(page, "part.phase === 'playing' && world.start_seed === 6")
        page.keyboard.press("n")
        wait_until(page, "part.phase === 'playing' && world.start_seed === 5")
        page.get_by_label("full", exact=True).check()
        wait_until(page, "part.phase === 'playing' && game.name === 'full at play'")
        assert page.get_by_label("Level").input_value() == "asked"
