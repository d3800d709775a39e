"""Runs the page in a real browser: Chromium or Chrome, as the machine has it."""

import os
import shutil
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import pytest

from .processes import PATIENCE
from .slow_pages import slow_down

NAMES = ("chromium", "chromium-browser", "google-chrome")
# Where it is set, as by `.ci/run`, tests fail that find no browser; elsewhere they are skipped.
REQUIRED = "ARKANOID_TESTS_NEED_BROWSER"
FLAGS = (
    *("--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync"),
    *("--disable-background-networking", "--disable-component-update"),
)
DESKTOP: dict[str, Any] = {"viewport": {"width": 1280, "height": 800}}
PHONE: dict[str, Any] = {
    "viewport": {"width": 390, "height": 844},
    "device_scale_factor": 3,
    "is_mobile": True,
    "has_touch": True,
}


@contextmanager
def run_browser() -> Iterator[Any]:
    """Run a browser; skip the test where there is none."""
    path = next(filter(None, map(shutil.which, NAMES)), None)
    if path is None:
        message = f"no browser here: none of {', '.join(NAMES)} is on the path"
        if os.environ.get(REQUIRED):
            pytest.fail(message)
        pytest.skip(message)
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=path, args=list(FLAGS), timeout=1000 * PATIENCE
        )
        try:
            yield browser
        finally:
            browser.close()


@contextmanager
def open_page(browser: Any, **context: Any) -> Iterator[Any]:
    """Open an empty page, in a context of its own; `context` is how it is shown."""
    opened = browser.new_context(**context)
    opened.set_default_timeout(1000 * PATIENCE)
    try:
        page = opened.new_page()
        slow_down(page)
        yield page
    finally:
        opened.close()


@contextmanager
def visit(browser: Any, address: str, asks: Sequence[str] = (), **context: Any) -> Iterator[Any]:
    """Open a page and wait until it runs; it must say nothing on the console, and ask no network.

    Args:
        browser: of `run_browser`.
        address: of the page.
        asks: what it may ask for in the folder of its address.
        context: how it is shown, such as `PHONE`.
    """
    faults: list[str] = []
    with open_page(browser, **context) as page:
        page.on("console", lambda message: faults.append(message.text))
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("request", lambda request: _note(request.url, address, asks, faults))
        page.goto(address)
        wait_until(page, "globalThis.arkanoid")
        yield page
        assert faults == []


def wait_until(page: Any, condition: str) -> None:
    """Wait until an expression of JavaScript is true.

    In it, ``part`` is the part of the page that is shown, ``game`` its game, and ``world`` the
    game's state. Playwright's own `wait_for_function` needs pages that allow ``eval``.
    """
    names = "const part = globalThis.arkanoid?.part, game = part?.game, world = game?.world"
    deadline = time.monotonic() + PATIENCE
    while not page.evaluate(f"() => {{ {names}; return Boolean({condition}); }}"):
        assert time.monotonic() < deadline, condition
        page.wait_for_timeout(20)


def pass_time(page: Any, milliseconds: int) -> None:
    """Let time pass by the page's own clock.

    However slow the machine is, what the page's timers were to do until then is done. Playwright's
    own `wait_for_timeout` waits outside of the page.
    """
    page.evaluate("(time) => new Promise((go) => setTimeout(go, time))", milliseconds)


def pass_pictures(page: Any) -> None:
    """Wait until the page has shown what there is now."""
    picture = "new Promise((go) => requestAnimationFrame(go))"
    page.evaluate(f"async () => {{ await {picture}; await {picture}; }}")


def _note(asked: str, address: str, asks: Sequence[str], faults: list[str]) -> None:
    page = address.partition("#")[0]
    known = (address, page, *(f"{page.rpartition('/')[0]}/{name}" for name in asks))
    if not asked.startswith(("data:", "blob:")) and asked not in known:
        faults.append(f"the page asks for {asked}")
