"""The page on small screens, and what it tells those who see less."""

from pathlib import Path
from typing import Any

import pytest
from helpers.browser import PHONE, visit, wait_until

PARTS = """[...document.querySelectorAll("nav a")].map(({ hash, textContent }) =>
  [hash.slice(1), textContent])"""
# Whatever can be pressed or typed into, and has no name for those who hear the page.
NAMELESS = """() => {
  const named = ({ ariaLabel, labels, textContent, title }) =>
    (ariaLabel || [...(labels ?? [])].map((label) => label.textContent).join("") || textContent
      || title).trim();
  return [...document.querySelectorAll("a, button, input:not([hidden]), select, summary, #picture")]
    .filter((one) => one.checkVisibility() && !one.ariaHidden && !named(one))
    .map((one) => one.outerHTML);
}"""
# The right end of what reaches beyond the window, if anything does.
TOO_FAR = """() => {
  const ends = [...document.querySelectorAll("nav a, button, input, select, svg")]
    .filter((one) => one.checkVisibility())
    .map((one) => one.getBoundingClientRect())
    .flatMap(({ left, right }) => [-left, right - innerWidth]);
  return [document.documentElement.scrollWidth - innerWidth, ...ends].filter((end) => end > 0.5);
}"""


def go_to(page: Any, part: str) -> None:
    """Show a part of the page, with all that it can unfold."""
    page.evaluate("part => { location.hash = part; }", part)
    wait_until(page, f"part === arkanoid._parts.{part} && arkanoid.open")
    page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")


@pytest.mark.parametrize("width", [320, 360, 390])
def test_narrow_screens(browser: Any, file: Path, width: int) -> None:
    """The tabs were wider than a screen of 320 pixels: the page moved sideways."""
    narrow = PHONE | {"viewport": {"width": width, "height": 640}}
    with visit(browser, file.as_uri(), **narrow) as page:
        for part, _ in page.evaluate(PARTS):
            go_to(page, part)
            assert page.evaluate(TOO_FAR) == [], part


def test_a_phone_on_its_side(browser: Any, file: Path) -> None:
    """The paddle was below the screen, and the page spoke of a mouse."""
    aside = PHONE | {"viewport": {"width": 844, "height": 390}}
    with visit(browser, file.as_uri(), **aside) as page:
        box = page.locator("#picture").bounding_box()
        assert box["y"] + box["height"] <= 390
        page.get_by_text("Drag to move, tap to fire").wait_for()


def test_each_part_has_a_title_and_names(page: Any) -> None:
    """All parts had one title; two fields of a body were called "y"."""
    for part, name in page.evaluate(PARTS):
        go_to(page, part)
        assert page.title() == f"{name} – Arkanoid"
        assert page.evaluate(NAMELESS) == []
    for name in ("position y", "velocity y"):
        assert page.get_by_label(name, exact=True).count() == 1


def test_numbers_that_always_change_are_not_read_out(page: Any) -> None:
    """Screen readers speak what an `output` says, and these say another thing in every picture."""
    for name in ("value", "time"):
        assert page.locator(f"#{name}").get_attribute("aria-live") == "off"
