"""Users who are faster than the page: they leave what still opens, and press what is not ready."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from helpers.browser import DESKTOP, pass_time, visit, wait_until

# What opens waits from now on, until `goOn` is called.
HOLD = """() => {
  const { promise, resolve } = Promise.withResolvers();
  globalThis.goOn = resolve;
  const { arkanoid: kernels } = arkanoid;
  for (const name of ["open", "board", "meeting", "sandbox"]) {
    const open = kernels[name].bind(kernels);
    kernels[name] = async (...given) => { await promise; return open(...given); };
  }
}"""
OPENED = {
    "watch": "part.phase === 'playing'",
    "replay": "part.phase === 'empty' && game",
    "editor": "part._level.bricks.length > 0",
    "collide": "document.querySelectorAll('.regions :is(polygon, circle)').length === 2",
    "world": "part.live.things().length > 5",
}


@pytest.fixture
def slow(browser: Any, file: Path) -> Iterator[Any]:
    """Return the page with a game, where other parts do not open yet."""
    with visit(browser, file.as_uri(), **DESKTOP) as page:
        page.evaluate(HOLD)
        yield page


def go_to(page: Any, part: str) -> None:
    page.evaluate("part => { location.hash = part; }", part)
    wait_until(page, f"part && part === arkanoid._parts.{part}")


@pytest.mark.parametrize("part", OPENED)
def test_a_part_that_opens_slowly(slow: Any, part: str) -> None:
    """Its buttons and keys failed; left and opened again meanwhile, the world was empty."""
    go_to(slow, part)
    buttons = f":is(#panel-{part}, #scene-{part}) button, #pause, #once"
    for place in slow.locator(buttons).filter(visible=True).all():
        box = place.bounding_box()
        if not place.text_content().startswith("Open"):  # files would be chosen
            slow.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    for key in ("n", "r", " ", "b", ".", "p", "t", "ArrowLeft", "Control+z"):
        slow.keyboard.press(key)
    if part not in ("collide", "world"):
        slow.locator("#picture").click(position={"x": 200, "y": 200})
    go_to(slow, "play")
    wait_until(slow, "arkanoid.open && part.phase === 'ready'")
    go_to(slow, part)
    assert not slow.evaluate("arkanoid.open")
    slow.evaluate("goOn()")
    wait_until(slow, f"arkanoid.open && {OPENED[part]}")
    assert slow.locator("[inert]:visible").count() == 0


@pytest.mark.parametrize("part", ["world", "collide"])
def test_leaving_what_still_opens(slow: Any, part: str) -> None:
    """Once open, it took the address and the focus of what one had gone on to."""
    for name in (part, "play", part, "play"):
        go_to(slow, name)
    wait_until(slow, "arkanoid.open")
    slow.get_by_label("Level", exact=True).focus()
    slow.evaluate("goOn()")
    pass_time(slow, 100)
    assert slow.evaluate("location.hash") == "#play"
    assert slow.evaluate("document.activeElement.id") == "play-level"
    go_to(slow, part)
    wait_until(slow, f"arkanoid.open && {OPENED[part]}")


def test_leaving_before_a_level_can_be_played(browser: Any, file: Path) -> None:
    """The level was given to the part that one had gone on to, which knows none."""
    with visit(browser, f"{file.as_uri()}#editor", **DESKTOP) as page:
        page.evaluate(HOLD)
        page.get_by_role("button", name="Play it").click()
        go_to(page, "world")
        page.evaluate("goOn()")
        wait_until(page, f"arkanoid.open && {OPENED['world']}")


def test_buttons_on_the_picture_are_those_of_the_part(slow: Any) -> None:
    """That of a game that paused stayed while the next part opened, and let the game go on."""
    slow.keyboard.press("Space")
    wait_until(slow, "world.decisions > 0")
    slow.keyboard.press("p")
    slow.locator("#notice button").wait_for()
    go_to(slow, "watch")
    assert slow.locator("#notice button").count() == 0
    slow.evaluate("goOn()")
    wait_until(slow, f"arkanoid.open && {OPENED['watch']}")


def test_a_link_of_which_the_page_has_not_heard_yet(browser: Any, file: Path) -> None:
    """A change of just before was written over it: browsers change the address first."""
    with visit(browser, f"{file.as_uri()}#world?b=Particle", **DESKTOP) as page:
        page.evaluate("""() => {
          arkanoid.part.light([1, 1]);
          history.replaceState(null, "", "#world?scene=pile");
        }""")
        pass_time(page, 400)
        assert page.evaluate("location.hash") == "#world?scene=pile"
