"""What goes wrong around a page: odd storage, slow displays, hasty users, other files."""

import json
from pathlib import Path
from typing import Any

import pytest
from helpers.browser import DESKTOP, PHONE, open_page, visit, wait_until

TICKS_OF = """async ([hertz, seconds]) => {
  const { Clock } = await import("arkanoid/clock");
  const clock = new Clock();
  performance.now = () => 0; // a picture may take no longer than its time, and this machine may
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
    page.evaluate("""() => {
      const change = () => { location.hash = "#editor"; };
      addEventListener("hashchange", change, { once: true }); // after the page has heard of it
      location.hash = "#watch";
    }""")
    wait_until(page, "part?.still && part.game && arkanoid._parts.watch.game")
    assert page.get_by_role("toolbar").count() == 0  # hidden ones have no role


def test_choosing_games_quickly(page: Any) -> None:
    """The game was the one that was ready last, and not the one that was chosen last."""
    page.evaluate(
        """() => {
          const [full, lite] = document.querySelectorAll("#panel-play input[type=radio]");
          lite.click();
          full.click();
        }"""
    )
    wait_until(page, "part.phase === 'ready' && part._recorders['lite by hand']")
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


def test_the_score_of_a_game_that_is_left(page: Any) -> None:
    """It was lost with the page; windows keep it."""
    page.keyboard.press("Space")
    wait_until(page, "world.decisions > 0")
    page.keyboard.press("p")
    page.evaluate("() => { arkanoid.part.game.world.score = 130; }")
    page.reload()
    wait_until(page, "part?.phase === 'ready'")
    assert page.locator("#scores li").all_text_contents()[0].startswith("1.130round 1")


def test_the_picture_is_in_the_middle_of_a_full_screen(page: Any) -> None:
    """It was in the corner."""
    page.keyboard.press("f")
    size = page.viewport_size
    for name in ("picture", "marks"):
        box = f"document.getElementById('{name}').getBoundingClientRect()"
        wait_until(page, f"document.fullscreenElement && {box}.height > 700")
        for side, length in (("x", "width"), ("y", "height")):
            middle = f"{box}.{side} + {box}.{length} / 2"
            wait_until(page, f"Math.abs({middle} - {size[length] / 2}) <= 1")


def test_a_window_that_goes_to_a_screen_with_more_pixels(page: Any) -> None:
    """Its picture was blurred: browsers tell of no new size."""
    before = page.evaluate("arkanoid.stage.scale")
    for density in (2, 3):
        page.context.new_cdp_session(page).send(
            "Emulation.setDeviceMetricsOverride",
            {"width": 1280, "height": 800, "deviceScaleFactor": density, "mobile": False},
        )
        wait_until(page, f"arkanoid.stage.scale >= {min(120, density * before)}")


def test_a_touch_that_the_system_takes_is_no_tap(browser: Any, file: Path) -> None:
    """It started the game: a gesture of the system begins as a touch, and is cancelled."""
    with visit(browser, file.as_uri(), **PHONE) as page:
        touch = page.context.new_cdp_session(page)
        box = page.locator("#picture").bounding_box()
        point = {"x": box["x"] + 50, "y": box["y"] + 50}
        for kind, points in (("touchStart", [point]), ("touchCancel", [])):
            touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
        assert page.evaluate("arkanoid.part.phase") == "ready"
        page.locator("#picture").tap()
        wait_until(page, "part.phase === 'playing'")


def test_fast_games_are_not_loud(page: Any) -> None:
    """Hundreds of tones began at once where a picture had hundreds of ticks."""
    page.evaluate("arkanoid.speaker.switch()")
    wait_until(page, "arkanoid.speaker._context.state === 'running'")
    began = page.evaluate(
        """() => {
          const { speaker } = arkanoid;
          let [began, time] = [0, speaker._context.currentTime];
          Object.defineProperty(speaker._context, "currentTime", { get: () => time });
          const { createOscillator: create } = AudioContext.prototype;
          speaker._context.createOscillator = function () { began += 1; return create.call(this); };
          return [0, 0, 0.01, 0.05, 0].map((later) => {
            time += later;
            for (let tick = 0; tick < 100; tick += 1) speaker._play("BRICK");
            return began;
          });
        }"""
    )
    assert began == [2, 2, 2, 4, 4]  # each tone is two waves


@pytest.mark.parametrize("last", [b'id="data-facts"', b"</script>"])
def test_a_page_that_is_cut_says_so(browser: Any, file: Path, tmp_path: Path, last: bytes) -> None:
    """It stayed empty, as after a download that was broken off, or lacked an agent."""
    cut = tmp_path / "cut.html"
    text = file.read_bytes()
    cut.write_bytes(text[: text.rindex(last)])
    with open_page(browser) as page:
        page.goto(cut.as_uri())
        page.get_by_text("The game does not start.").wait_for()
