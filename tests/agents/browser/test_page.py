"""The page in a real browser: by keys, mouse and touch, on a desk and on a phone."""

import base64
import json
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.envs.levels import load_level
from arkanoid.envs.play.by_hand import BY_HAND
from helpers.browser import DESKTOP, PHONE, visit, wait_until

MOST_BYTES = 1_500_000
PIXELS = """() => {
  const { width, height } = arkanoid.stage.canvas;
  const { data } = arkanoid.stage.canvas.getContext("2d").getImageData(0, 0, width, height);
  let text = "";
  for (const byte of data) text += String.fromCharCode(byte);
  return [height, width, btoa(text)];
}"""


def phase(page: Any) -> str:
    return page.evaluate("arkanoid.part.phase")


def world(page: Any, field: str) -> Any:
    return page.evaluate(f"arkanoid.part.game.world.{field}")


def test_one_file_has_all_and_asks_for_nothing(file: Path) -> None:
    content = file.read_bytes()
    assert len(content) < MOST_BYTES
    assert b'src="http' not in content
    assert b'href="http' not in content


def test_the_canvas_shows_what_render_returns(page: Any) -> None:
    """Pixel for pixel, after a second of the same game."""
    page.evaluate("arkanoid.part._recorder.reset({ seed: 7 })")
    for _ in range(60):
        page.keyboard.press(".")
    wait_until(page, "!arkanoid.stage.stale")
    height, width, pixels = page.evaluate(PIXELS)
    env = gym.make(
        "arkanoid:Arkanoid-v0", render_mode="rgb_array", render_size=(height, width), **BY_HAND
    )
    env.reset(seed=7)
    for _ in range(60):
        env.step(np.zeros(2, np.float32))
    shown = np.frombuffer(base64.b64decode(pixels), np.uint8).reshape(height, width, 4)
    np.testing.assert_array_equal(shown[..., :3], env.render())
    assert (shown[..., 3] == 255).all()
    env.close()


def test_playing_by_keys(page: Any) -> None:
    assert phase(page) == "ready"
    page.keyboard.press("Space")
    wait_until(page, "part.phase === 'playing' && world.decisions > 0")
    before = world(page, "paddle_x")
    page.keyboard.down("ArrowLeft")
    wait_until(page, f"world.paddle_x < {before - 1}")
    page.keyboard.up("ArrowLeft")
    page.keyboard.down("d")
    wait_until(page, f"world.paddle_x > {before}")
    page.keyboard.up("d")
    page.keyboard.press("p")
    assert phase(page) == "paused"
    played = world(page, "decisions")
    page.keyboard.press(".")
    assert world(page, "decisions") == played + 1
    page.keyboard.press("r")
    assert phase(page) == "asked"
    page.keyboard.press("r")
    wait_until(page, "part.phase === 'ready' && world.decisions === 0")
    page.keyboard.press("+")
    wait_until(page, "document.getElementById('speed').textContent === '2×'")


def test_a_page_for_the_keyboard_alone(page: Any) -> None:
    """Tab comes to everything that can be pressed, and each says what it is."""
    reached = set()
    for _ in range(30):
        page.keyboard.press("Tab")
        reached.add(
            page.evaluate(
                "(({ tagName, ariaLabel, textContent, labels, id }) => JSON.stringify("
                "[tagName, (ariaLabel ?? labels?.[0]?.textContent ?? textContent).trim() || id]))"
                "(document.activeElement)"
            )
        )
    names = {json.loads(one)[1] for one in reached}
    wanted = {"Play", "Watch", "Start", "One tick", "Slower", "Faster", "Sound", "Full screen"}
    assert wanted | {"Full", "Level", "Restart", "Next round"} <= names


def test_playing_by_mouse(page: Any) -> None:
    """Tick by tick: after a second, the ball serves itself."""
    page.evaluate("arkanoid.clock.speed = 0")
    page.get_by_role("button", name="Start").first.click()
    box = page.locator("#picture").bounding_box()
    page.mouse.move(box["x"] + box["width"] / 12 * 3.5, box["y"] + box["height"] / 2)
    page.evaluate("() => { for (let tick = 0; tick < 50; tick += 1) arkanoid.part.tick(); }")
    assert world(page, "paddle_x") == pytest.approx(3, abs=0.02)
    assert world(page, "ball_state[0]") == 1
    page.mouse.down()
    page.evaluate("arkanoid.part.tick()")
    assert world(page, "ball_state[0]") == 2
    page.mouse.up()


def test_where_a_game_begins(page: Any) -> None:
    page.get_by_label("Level").select_option(label="10 · Spiral")
    wait_until(page, "part.phase === 'ready' && world.round_number === 10")
    kinds = page.evaluate("Array.from(arkanoid.part.game.world.kind)")
    assert kinds == load_level("spiral").kinds.ravel().tolist()
    page.get_by_label("Lite").check()
    wait_until(page, "part.phase === 'ready' && game.name === 'lite by hand'")
    page.get_by_label("Level").select_option("generated")
    page.get_by_label("Its number").fill("11")
    page.get_by_label("Its number").press("Enter")
    wait_until(page, "world.start_seed === 11")
    assert world(page, "start_difficulty") == 0.5


def test_another_level_in_the_middle_of_a_game_is_asked_for(page: Any) -> None:
    """The game was gone at once, by a slip of the mouse or a key."""
    page.keyboard.press("Space")
    wait_until(page, "world.decisions > 5")
    level = page.get_by_label("Level", exact=True)
    level.select_option("4")
    assert phase(page) == "asked"
    assert page.locator("#said").text_content() == "Change the game?"
    level.select_option("5")  # no answer
    assert phase(page) == "asked"
    page.get_by_role("button", name="No, go on").click()
    assert level.input_value() == "1"
    wait_until(page, "part.phase === 'playing' && world.round_number === 1")
    page.get_by_label("Lite").check()
    assert phase(page) == "asked"
    page.locator("[data-do=restart]").click()
    assert page.get_by_label("Full", exact=True).is_checked()
    page.get_by_role("button", name="No, go on").click()
    wait_until(page, "part.phase === 'playing' && world.decisions > 5")
    level.select_option("4")
    page.get_by_role("button", name="Yes, leave this game").click()
    wait_until(page, "part.phase === 'ready' && world.round_number === 4")


def test_a_level_of_the_editor_in_the_middle_of_a_game_is_asked_for(page: Any) -> None:
    page.keyboard.press("Space")
    wait_until(page, "world.decisions > 5")
    page.get_by_role("link", name="Editor").click()
    page.locator("[data-edit=play]").click()
    wait_until(page, "part.phase === 'asked'")
    assert world(page, "decisions") > 5
    page.get_by_role("button", name="Yes, leave this game").click()
    wait_until(page, "part.phase === 'ready' && world.start_kind.some(Boolean)")


def test_two_keys_for_one_direction(page: Any) -> None:
    """When one of them was let go, the paddle stood still, though the other one was held."""
    page.keyboard.press("Space")
    wait_until(page, "world.decisions > 0")
    page.keyboard.down("ArrowLeft")
    page.keyboard.down("a")
    page.keyboard.up("ArrowLeft")
    assert page.evaluate("arkanoid.part._controls.command(0, 1)[0]") == -1
    page.keyboard.up("a")
    assert page.evaluate("arkanoid.part._controls.command(0, 1)[0]") == 0
    # The mouse's button is another key for fire.
    page.locator("#picture").hover()
    page.keyboard.down("Space")
    page.mouse.down()
    page.mouse.up()
    page.evaluate("arkanoid.part._controls.command(0, 1)")
    assert page.evaluate("arkanoid.part._controls.command(0, 1)[1]") == 1
    page.keyboard.up("Space")
    page.evaluate("arkanoid.part._controls.command(0, 1)")
    assert page.evaluate("arkanoid.part._controls.command(0, 1)[1]") == 0


def test_high_scores_are_kept(page: Any) -> None:
    """The balls fall out; the score is of the game's first seconds."""
    page.evaluate("arkanoid.clock.speed = 64")
    page.keyboard.press("Space")
    page.keyboard.down("Space")
    wait_until(page, "part.phase === 'over'")
    page.keyboard.up("Space")
    score = world(page, "score")
    assert score > 0
    page.reload()
    wait_until(page, "globalThis.arkanoid")
    assert page.locator("#scores li").first.text_content().startswith(f"1.{score}round 1")


def test_playing_by_touch(browser: Any, file: Path) -> None:
    with visit(browser, file.as_uri(), **PHONE) as page:
        assert page.evaluate("document.documentElement.scrollWidth") == 390
        page.locator("#picture").tap()
        wait_until(page, "part.phase === 'playing'")
        strip = page.locator("#strip").bounding_box()
        touch = page.context.new_cdp_session(page)

        def send(kind: str, *points: float) -> None:
            y = strip["y"] + 20
            places = [{"x": strip["x"] + x * strip["width"], "y": y} for x in points]
            touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": places})

        send("touchStart", 0.5)
        send("touchMove", 0.25)
        wait_until(page, "Math.abs(world.paddle_x - 2.5) < 0.05")
        send("touchEnd")
        page.locator("#strip").tap()
        wait_until(page, "world.ball_state[0] === 2 || world.lives < 3")


def test_sound_begins_when_it_is_asked_for(page: Any) -> None:
    button = page.get_by_label("Sound")
    assert button.get_attribute("aria-pressed") == "false"
    page.keyboard.press("m")
    assert button.get_attribute("aria-pressed") == "true"
    page.keyboard.press("Space")
    page.keyboard.press("Space")
    wait_until(page, "world.decisions > 30")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_colours_can_be_read(browser: Any, file: Path, scheme: str) -> None:
    """Text stands out from its ground by 4.5 at least, as WCAG asks."""
    with visit(browser, file.as_uri(), **DESKTOP, color_scheme=scheme) as page:
        style = "getComputedStyle(document.documentElement).getPropertyValue"

        def luminance(name: str) -> float:
            text = page.evaluate(f"{style}('{name}')")
            text = text.strip().lstrip("#")
            text = "".join(2 * letter for letter in text) if len(text) == 3 else text
            parts = np.array([int(text[place : place + 2], 16) for place in (0, 2, 4)]) / 255
            linear = np.where(parts <= 0.03928, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
            return float(linear @ [0.2126, 0.7152, 0.0722])

        for text, ground in [
            ("--ink", "--ground"),
            ("--ink", "--card"),
            ("--soft", "--ground"),
            ("--soft", "--hover"),
            ("--on-accent", "--accent"),
            ("--plus", "--ground"),
            ("--minus", "--ground"),
        ]:
            low, high = sorted(map(luminance, (text, ground)))
            assert (high + 0.05) / (low + 0.05) >= 4.5, (text, ground)
