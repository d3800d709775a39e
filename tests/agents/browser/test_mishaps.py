"""What goes wrong around a page: odd storage, slow displays, hasty users, other files."""

import json
from pathlib import Path
from typing import Any

import pytest
from helpers.browser import DESKTOP, visit, wait_until

TICKS_OF = """async ([hertz, seconds]) => {
  const { Clock } = await import("arkanoid/clock");
  const clock = new Clock();
  let ticks = 0;
  clock.run(0, 60, () => false);
  for (let picture = 1; picture <= hertz * seconds; picture += 1) {
    clock.run((1000 * picture) / hertz, 60, () => Boolean((ticks += 1)));
  }
  return ticks;
}"""


@pytest.mark.parametrize(
    "held",
    [
        "{{{",
        "[1]",
        "5",
        json.dumps({"full by hand {}": 5}),
        json.dumps({"full by hand {}": [None]}),
    ],
)
def test_scores_that_are_none(page: Any, held: str) -> None:
    """The page did not start where the browser held something else, as of another release."""
    page.evaluate("held => localStorage.setItem('arkanoid.scores', held)", held)
    page.reload()
    wait_until(page, "part?.phase === 'ready'")
    assert page.evaluate("arkanoid.scores.add('full by hand {}', 70, 1)") == 0
    page.reload()
    wait_until(page, "part?.phase === 'ready'")
    assert page.locator("#scores li").first.text_content().startswith("1.70round 1")


def test_scores_of_a_full_storage_are_kept_as_long_as_the_page(page: Any) -> None:
    """The older ones, read anew, took the place of those that could not be written."""
    page.evaluate("arkanoid.scores.add('one', 70, 1)")
    page.evaluate("() => { Storage.prototype.setItem = () => { throw new Error('full'); }; }")
    assert page.evaluate("arkanoid.scores.add('one', 80, 1)") == 0
    assert page.evaluate("arkanoid.scores.best('one').map(({ score }) => score)") == [80, 70]


@pytest.mark.parametrize("hertz", [11, 30, 60, 144, 240])
def test_displays_do_not_change_the_pace(page: Any, hertz: int) -> None:
    assert page.evaluate(TICKS_OF, [hertz, 10]) == pytest.approx(600, abs=1)


def test_a_slow_display_makes_the_game_slow_and_does_not_stop_it(page: Any) -> None:
    """It stood still where a picture took more than a tenth of a second."""
    assert page.evaluate(TICKS_OF, [5, 10]) == pytest.approx(300, abs=1)


def test_changing_parts_quickly(page: Any) -> None:
    """The controls were those of the part that was ready last."""
    page.evaluate("location.hash = '#watch'; setTimeout(() => { location.hash = '#editor'; }, 0)")
    wait_until(page, "part?.still && part.game && arkanoid._parts.watch.game")
    page.wait_for_timeout(100)
    assert page.locator(".bar").is_hidden()


def test_choosing_games_quickly(page: Any) -> None:
    """The game was the one that was ready last, and not the one that was chosen last."""
    page.evaluate(
        """() => {
          const [full, lite] = document.querySelectorAll("#panel-play input[type=radio]");
          lite.click();
          full.click();
        }"""
    )
    page.wait_for_timeout(300)
    wait_until(page, "part.phase === 'ready'")
    assert page.evaluate("arkanoid.part.game.name") == "full by hand"


def test_a_key_that_is_let_go_elsewhere(browser: Any, file: Path) -> None:
    """The paddle went on to move when one came back."""
    with visit(browser, f"{file.as_uri()}#watch", **DESKTOP) as page:
        wait_until(page, "part.phase === 'playing'")
        page.keyboard.down("ArrowLeft")
        assert page.evaluate("arkanoid.part.steers")
        page.get_by_role("link", name="Play", exact=True).click()
        wait_until(page, "part.phase === 'ready'")
        page.keyboard.up("ArrowLeft")
        page.get_by_role("link", name="Watch").click()
        wait_until(page, "part.phase === 'playing'")
        assert page.evaluate("arkanoid.part._controls._held.size") == 0


def test_keys_without_names(page: Any) -> None:
    """As browsers send them when they fill in a form."""
    for kind in ("keydown", "keyup"):
        page.evaluate("kind => document.body.dispatchEvent(new Event(kind, {bubbles: true}))", kind)


def test_buttons_of_the_editor_by_the_space_key(page: Any) -> None:
    """Space painted, wherever the focus was."""
    page.get_by_role("link", name="Editor").click()
    wait_until(page, "part.still && part.game")
    page.get_by_role("button", name="Clear").focus()
    page.keyboard.press("Space")
    assert set(page.evaluate("arkanoid.part._level.bricks")) == {"."}
