"""What went wrong in World and Collide: quick changes, second fingers, half-typed numbers."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from helpers.browser import DESKTOP, PHONE, pass_pictures, pass_time, visit, wait_until

STILL = "#world?gravity=5&b=Particle,-4,0,0,0,1&b=AxisAlignedRectangle,4,0,0,0,2,2"
APART = "#collide?a=Particle,-3,0,2,0&b=Particle,3,0"
PICTURES = """async () => {
  const { arena } = arkanoid.part;
  const { paint } = arena;
  const { promise, resolve } = Promise.withResolvers();
  let [painted, pictures] = [0, 0];
  arena.paint = function (...shown) { painted += 1; return paint.apply(this, shown); };
  const count = () => {
    pictures += 1;
    if (pictures < 10) requestAnimationFrame(count);
    else resolve();
  };
  requestAnimationFrame(count);
  await promise;
  return painted / pictures;
}"""


@pytest.fixture
def world(browser: Any, file: Path) -> Iterator[Any]:
    """Return the page with two bodies, while time stands still."""
    with visit(browser, file.as_uri() + STILL, **DESKTOP) as page:
        wait_until(page, "part.live")
        page.click("#world-pause")
        yield page


@pytest.fixture
def phone(browser: Any, file: Path) -> Iterator[Any]:
    """Return the same on a telephone."""
    with visit(browser, file.as_uri() + STILL, **{**PHONE, "reduced_motion": "reduce"}) as page:
        wait_until(page, "part.live && !part.runs")
        page.locator("#world-picture").scroll_into_view_if_needed()
        yield page


def things(page: Any) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = page.evaluate("arkanoid.part.live.things()")
    return found


def pixel(page: Any, x: float, y: float) -> tuple[float, float]:
    box = page.locator("#world-picture").bounding_box()
    unit = box["width"] / 24.9
    return box["x"] + box["width"] / 2 + unit * x, box["y"] + box["height"] / 2 - unit * y


class Fingers:
    """Touches a page at as many places as there are fingers."""

    def __init__(self, page: Any) -> None:
        self._session = page.context.new_cdp_session(page)

    def __call__(self, kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": x, "y": y, "id": finger} for finger, (x, y) in enumerate(places)]
        message = {"type": f"touch{kind}", "touchPoints": points}
        self._session.send("Input.dispatchTouchEvent", message)


def throw(page: Any) -> None:
    page.mouse.click(*pixel(page, 0, 4))


def test_scenes_are_painted_once(browser: Any, file: Path) -> None:
    """Each link to a scene painted the world once more in every picture."""
    with visit(browser, file.as_uri() + "#world", **DESKTOP) as page:
        wait_until(page, "part.live")
        for name in ("cradle", "pile", "gate"):
            page.click(f"#world-scenes a[data-scene={name}]")
            wait_until(page, f"part._start.name === '{name}'")
        assert page.evaluate(PICTURES) <= 1.2


def test_leaving_right_after_a_change(world: Any) -> None:
    """The address became that of the world, and the page showed the game."""
    world.evaluate("arkanoid.part.remove(arkanoid.part.choose(0)); location.hash = '#play'")
    wait_until(world, "part?.phase === 'ready'")
    pass_time(world, 400)
    assert world.evaluate("location.hash") == "#play"


def test_a_link_right_after_a_change(world: Any) -> None:
    """It was overwritten: the scene did not open."""
    throw(world)
    world.evaluate("document.querySelector('#world-scenes a[data-scene=pile]').click()")
    wait_until(world, "part._start.name === 'pile'")
    pass_time(world, 400)
    assert world.evaluate("location.hash") == "#world?scene=pile"


def test_a_link_to_a_scene_can_be_undone(world: Any) -> None:
    """It took the world that one had built, and all that could be undone before."""
    throw(world)
    before = things(world)
    hits = world.evaluate("arkanoid.part.meters.hits = 7")
    for name in ("pile", "cradle"):
        world.click(f"#world-scenes a[data-scene={name}]")
        wait_until(world, f"part._start.name === '{name}'")
    world.click("#world-undo")
    assert world.locator("#world-scenes [aria-current]").text_content() == "A pile of crates"
    wait_until(world, "location.hash === '#world?scene=pile'")
    world.click("#world-undo")
    assert things(world) == before
    assert world.evaluate("arkanoid.part.meters.hits") == hits
    assert world.locator("#gravity").input_value() == "5"
    wait_until(world, "location.hash.split('&b=').length === 4")
    world.click("#world-undo")
    assert len(things(world)) == 2
    assert world.locator("#world-undo").is_disabled()


@pytest.mark.parametrize(
    ("given", "shown"),
    [
        *[("1e308,1e308", [12, 8]), ("-1e9,0.333", [-12, 0.33]), ("12.4,-9", [12, -8])],
        *[(text, None) for text in ("1e400,0", "NaN,0", "0,-Infinity", "inf,0", ",", "1", "1,2,3")],
    ],
)
def test_the_lamp_of_an_address(
    browser: Any, file: Path, given: str, shown: list[float] | None
) -> None:
    """One far away was lit, but nowhere: it stays in the picture, or there is none."""
    scene = f"#world?lamp={given}&gravity=1e99&b=Particle"
    with visit(browser, file.as_uri() + scene, **DESKTOP) as page:
        wait_until(page, "part.live?.sandbox.record.time > 0")
        assert page.evaluate("arkanoid.part.lamp") == shown
        assert page.is_checked("#lamp") == (shown is not None)
        assert page.locator("#gravity").input_value() == "100"
        lamp = f"&lamp={shown[0]:g},{shown[1]:g}" if shown else ""
        assert page.evaluate("location.hash") == f"#world?gravity=100{lamp}&b=Particle"


@pytest.mark.parametrize("number", ["1e308", "-1e308", "1e400", "NaN", "Infinity", "5e-324"])
def test_bodies_with_such_numbers(browser: Any, file: Path, number: str) -> None:
    """Each shows what can be: its fields hold numbers, and nothing on the page is NaN."""
    numbers = ",".join([number] * 8)
    kinds = ("Particle", "AxisAlignedRectangle", "Rectangle", "Convex", "AxisAlignedHalfPlane")
    bodies = "&".join(f"b={kind},{numbers}" for kind in kinds)
    with visit(browser, file.as_uri() + f"#world?{bodies}&b=Particle", **DESKTOP) as page:
        wait_until(page, "part.live?.sandbox.record.time > 0.05 || !part.runs")
        for row in range(len(things(page))):
            page.evaluate(f"arkanoid.part.choose({row})")
            pass_pictures(page)
            shown = page.inner_text("main")
            assert not re.search("NaN|null|undefined|Infinity", shown), shown
        sides = "&".join(f"{side}=Convex,{numbers}" for side in "ab")
        page.evaluate(f"location.hash = '#collide?{sides}'")
        wait_until(page, "part.opened")
        assert not re.search("NaN|null|undefined|Infinity", page.inner_text("main"))


def test_coming_back_to_the_world(world: Any) -> None:
    """The address did not hold it any more: reloaded, it was gone."""
    throw(world)
    world.get_by_role("link", name="Play", exact=True).click()
    wait_until(world, "part?.phase === 'ready'")
    world.get_by_role("link", name="World", exact=True).click()
    wait_until(world, "location.hash.split('&b=').length === 4")
    before = things(world)
    world.emulate_media(reduced_motion="reduce")
    world.reload()
    wait_until(world, "globalThis.arkanoid?.part?.live")
    assert things(world) == before


def test_coming_back_to_a_collision(browser: Any, file: Path) -> None:
    """As for the world; and leaving at once does not change the address of the game."""
    with visit(browser, file.as_uri() + APART, **DESKTOP) as page:
        page.evaluate("arkanoid.part.change('a', { x: -2 }); location.hash = '#play'")
        wait_until(page, "part?.phase === 'ready'")
        pass_time(page, 400)
        assert page.evaluate("location.hash") == "#play"
        page.get_by_role("link", name="Collide").click()
        wait_until(page, "location.hash.startsWith('#collide?a=Particle,-2,0')")


@pytest.mark.parametrize("part", ["world", "collide"])
def test_typing_a_small_mass(browser: Any, file: Path, part: str) -> None:
    """The 0 with which it begins meant none, and closed the field."""
    scene = STILL if part == "world" else APART
    with visit(browser, file.as_uri() + scene, **DESKTOP) as page:
        wait_until(page, "part.live || part.opened")
        if part == "world":
            page.evaluate("arkanoid.part.choose(0)")
        field = page.locator(f"#panel-{part} input[name=mass]")
        field.select_text()
        page.keyboard.type("0.5")
        page.keyboard.press("Enter")
        told = "live.thing(arkanoid.part.chosen)" if part == "world" else "bodies.b"
        assert page.evaluate(f"arkanoid.part.{told}.mass") == 0.5
        field.fill("0")
        page.keyboard.press("Enter")
        assert field.input_value() == "0.5"


def test_typing_gravity(world: Any) -> None:
    """Each digit was a change to undo; one too many stayed in the field."""
    field = world.locator("#gravity")
    field.select_text()
    world.keyboard.type("500")
    world.keyboard.press("Tab")
    assert field.input_value() == "50"
    assert world.evaluate("arkanoid.part.gravity") == 50
    world.click("#world-undo")
    assert world.evaluate("arkanoid.part.gravity") == 5
    assert world.locator("#world-undo").is_disabled()


def test_a_slider_after_undo(world: Any) -> None:
    """What it did then could not be undone."""
    world.evaluate("arkanoid.part.choose(0)")
    for value in ("0.5", "0.2"):
        world.locator("#thing-restitution").fill(value)
        world.click("#world-undo")
        assert things(world)[0]["restitution"] == 1


def test_a_second_finger(phone: Any) -> None:
    """The body that the first one holds flew to it."""
    touch, other = Fingers(phone), pixel(phone, 8, -4)
    touch("Start", pixel(phone, -4, 0))
    touch("Move", pixel(phone, -5, 2))
    touch("Start", pixel(phone, -5, 2), other)
    touch("Move", pixel(phone, -6, 3), other)
    touch("Move", pixel(phone, -6, 3), pixel(phone, 8, -5))
    touch("End")
    held, _ = things(phone)
    assert (held["x"], held["y"]) == pytest.approx((-6, 3), abs=0.1)


def test_a_touch_that_the_system_takes(phone: Any) -> None:
    """It threw something in, which could not be undone, and which the address lacked."""
    touch = Fingers(phone)
    touch("Start", pixel(phone, 0, 4))
    touch("Move", pixel(phone, 2, 5))
    assert len(things(phone)) == 3
    touch("Cancel")
    assert len(things(phone)) == 2
    assert phone.locator("#world-undo").is_disabled()


def test_a_second_finger_in_a_collision(browser: Any, file: Path) -> None:
    """As in a world: the body flew to it."""
    with visit(browser, file.as_uri() + APART, **DESKTOP) as page:
        wait_until(page, "part.opened")
        box = page.locator("#collisions .regions .a").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x, y - 40)
        before = page.evaluate("arkanoid.part.bodies.a.y")
        for kind in ("pointermove", "pointerup"):
            other = {"pointerId": 77, "clientX": x, "clientY": y + 90, "bubbles": True}
            page.locator("#collisions").dispatch_event(kind, other)
        assert page.evaluate("arkanoid.part.bodies.a.y") == before > 0.5
        page.mouse.move(x, y - 60)
        assert page.evaluate("arkanoid.part.bodies.a.y") > before
        page.mouse.up()


def test_a_body_that_is_far_away(browser: Any, file: Path) -> None:
    """The address brought it back to 1000 units from here."""
    scene = "#world?gravity=0&b=Particle,0,-20116.5,0,-2005.25"
    context = {**DESKTOP, "reduced_motion": "reduce"}
    with visit(browser, file.as_uri() + scene, **context) as page:
        wait_until(page, "part.live")
        assert (things(page)[0]["y"], things(page)[0]["vy"]) == (-20116.5, -2005.25)
