"""The world to throw things in, in a real browser."""

import contextlib
import io
import re
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arkanoid.physics.scenes.ready import SCENES, Thing, make_world, text_of
from helpers.browser import DESKTOP, PHONE, pass_pictures, visit, wait_until
from helpers.repository import ROOT

STILL = "#world?gravity=0&b=Particle,-4,0,0,0,1&b=AxisAlignedRectangle,4,0,0,0,2,2"
THING = Thing._fields
SITE = (ROOT / "docs" / "site" / "playable.py").read_text(encoding="utf-8")


def open_world(browser: Any, file: Path, scene: str, **context: Any) -> Any:
    return visit(browser, file.as_uri() + scene, **(context or DESKTOP))


@pytest.fixture
def world(browser: Any, file: Path) -> Iterator[Any]:
    """Return the page with two bodies that rest, while time stands still."""
    with open_world(browser, file, STILL) as page:
        wait_until(page, "part.live")
        page.click("#world-pause")
        yield page


def things(page: Any) -> list[Thing]:
    found = page.evaluate("arkanoid.part.live.things()")
    return [Thing(**{name: thing[name] for name in THING}) for thing in found]


def pixel(page: Any, x: float, y: float) -> tuple[float, float]:
    """Return where a place of the world is on the screen."""
    box = page.locator("#world-picture").bounding_box()
    unit = box["width"] / 24.9
    return box["x"] + box["width"] / 2 + unit * x, box["y"] + box["height"] / 2 - unit * y


def drag(page: Any, start: tuple[float, float], end: tuple[float, float]) -> None:
    page.mouse.move(*pixel(page, *start))
    page.mouse.down()
    page.mouse.move(*pixel(page, *end), steps=6)
    page.mouse.up()


def fling(page: Any, start: tuple[float, float], end: tuple[float, float], seconds: float) -> None:
    """Drag evenly, and let go while the pointer moves, however long that takes here."""
    mouse, count, began = page.context.new_cdp_session(page), 10, time.time()
    page.mouse.move(*pixel(page, *start))
    for number in range(count + 2):
        part = min(1.0, number / count)
        x, y = pixel(page, *(a + part * (b - a) for a, b in zip(start, end, strict=True)))
        kind = {0: "mousePressed", count + 1: "mouseReleased"}.get(number, "mouseMoved")
        event = {"type": kind, "x": x, "y": y, "button": "left", "buttons": 1, "clickCount": 1}
        when = {"timestamp": began + part * seconds}
        mouse.send("Input.dispatchMouseEvent", event | when)


@pytest.mark.parametrize("name", SCENES)
def test_scenes_are_those_of_python(browser: Any, file: Path, name: str) -> None:
    """A link opens each; its steps give what Python's `World` gives, to the last digits.

    Only the numbers of turned polygons differ in them, so only scenes without are equal for long.
    """
    scene = SCENES[name]
    steps = 5 if name == "crowd" else 40
    context = {**DESKTOP, "reduced_motion": "reduce"}
    with open_world(browser, file, f"#world?scene={name}", **context) as page:
        wait_until(page, "part.live && !part.runs")
        page.locator("#world-picture").focus()
        for _ in range(steps):
            page.keyboard.press(".")
        shown = things(page)
    world = make_world(scene.things)
    for _ in range(steps):
        for handle, thing in enumerate(scene.things):
            if scene.gravity and thing.mass > 0:
                vx, vy = world.velocity(handle)
                world.place(handle, velocity=(vx, vy - scene.gravity * (1 / 60)))
        world.step(1 / 60)
    places = np.array([(thing.x, thing.y, thing.vx, thing.vy) for thing in shown], np.float64)
    expected = np.hstack([world.positions, world.velocities])
    if any(thing.collider == "Convex" for thing in scene.things):
        assert np.abs(places - expected).max() < 1e-9
    else:
        assert places.tobytes() == expected.tobytes()


def test_the_scenes_run(browser: Any, file: Path) -> None:
    """By themselves, and no energy appears where nothing is lost."""
    with open_world(browser, file, "#world") as page:
        wait_until(page, "part.meters.hits > 0 && part.live.sandbox.record.time > 2")
        energies = page.evaluate("arkanoid.part.meters._energies")
        assert max(energies) - min(energies) < 1e-9 * max(energies)
        page.click("#world-scenes a[data-scene=gate]")
        wait_until(page, "document.getElementById('world-events').textContent.includes('BEGIN')")


def test_pulling_throws_in(world: Any) -> None:
    """The arrow's length is the speed; undo takes it out again."""
    drag(world, (0, 3), (2, 4))
    *_, thrown = things(world)
    assert (thrown.x, thrown.y) == pytest.approx((0, 3), abs=0.05)
    assert (thrown.vx, thrown.vy) == pytest.approx((8, 4), abs=0.3)
    assert thrown.width == 0.8
    world.click("#world-undo")
    assert len(things(world)) == 2
    assert world.locator("#world-undo").is_disabled()


@pytest.mark.parametrize(
    "kind", ["disc", "point", "box", "turned box", "triangle", "trapezium", "pentagon"]
)
def test_all_shapes(world: Any, kind: str) -> None:
    """A tap puts each in, at rest."""
    world.select_option("#kind", kind)
    world.mouse.click(*pixel(world, 0, -4))
    *_, thrown = things(world)
    assert (thrown.vx, thrown.vy) == (0, 0)
    assert thrown.collider == {
        "disc": "Particle",
        "point": "Particle",
        "box": "AxisAlignedRectangle",
        "turned box": "Rectangle",
    }.get(kind, "Convex")
    assert (thrown.width == 0) == (kind == "point")


def test_dragging_and_flinging(world: Any) -> None:
    """While time stands still, a drag moves a body; while it runs, the body flies on."""
    drag(world, (-4, 0), (-6, 3))
    moved = things(world)[0]
    assert (moved.x, moved.y) == pytest.approx((-6, 3), abs=0.05)
    assert (moved.vx, moved.vy) == (0, 0)
    world.click("#world-pause")
    fling(world, (-6, 3), (-1, 3), seconds=0.2)
    flung = things(world)[0]
    assert flung.vx == pytest.approx(25, rel=0.05)
    assert abs(flung.vy) < 0.1


def test_the_arrow_of_a_chosen_body(world: Any) -> None:
    """Its tip is the velocity, and can be dragged."""
    drag(world, (0, 3), (2, 3))
    world.mouse.click(*pixel(world, 0, 3))
    drag(world, (2, 3), (0, 5))
    *_, thrown = things(world)
    assert (thrown.vx, thrown.vy) == pytest.approx((0, 8), abs=0.3)
    assert (thrown.x, thrown.y) == pytest.approx((0, 3), abs=0.05)


def test_the_form_changes_a_body(world: Any) -> None:
    """Mass, restitution, sensor and shape of the body that is chosen."""
    world.mouse.click(*pixel(world, 4, 0))
    assert world.locator("#thing-title").text_content() == "This box"
    world.fill("#thing-mass", "2.5")
    world.locator("#thing-restitution").fill("0.5")
    world.locator("#thing-width").fill("3")
    world.select_option("#kind", "triangle")
    changed = things(world)[1]
    assert (changed.mass, changed.restitution, changed.width) == (2.5, 0.5, 3)
    assert changed.polygon == "triangle"
    world.check("#thing-form [name=sensor]")
    world.check("#thing-form [name=still]")
    changed = things(world)[1]
    assert (changed.mass, changed.sensor) == (0, 1)
    world.click("#world-remove")
    assert len(things(world)) == 1


def test_the_address_holds_the_world(world: Any, browser: Any, file: Path) -> None:
    """As it was last changed; opened elsewhere it is the same, and *Again* goes back to it."""
    drag(world, (0, 3), (1, 3.5))
    wait_until(world, "location.hash.split('&b=').length === 4")
    link, before = world.evaluate("location.hash"), things(world)
    assert len(link) < 120
    with open_world(browser, file, link, reduced_motion="reduce", **DESKTOP) as page:
        wait_until(page, "part.live")
        assert things(page) == before
    for _ in range(20):
        world.click("#world-once")
    assert things(world) != before
    world.click("#world-again")
    assert things(world) == before


def test_the_site_links_to_scenes_that_there_are() -> None:
    """Each figure of many bodies on the engine's page has one."""
    names = re.findall(r'"\w+": "scene=(\w+)"', SITE)
    assert len(names) == 2
    assert set(names) <= set(SCENES)


def test_odd_addresses(browser: Any, file: Path) -> None:
    """What makes no sense is as if it were missing."""
    for query in ("scene=none", "b=Blob,x,1e999,,,-3", "gravity=x&lamp=1", "b=Convex,0,0,0,0,-1"):
        with open_world(browser, file, f"#world?{query}") as page:
            wait_until(page, "part.live.sandbox.record.time > 0.1")


def test_by_keyboard_alone(world: Any) -> None:
    """Throw in, choose, move, kick, undo, remove, run."""
    world.locator("#world-picture").focus()
    press = world.keyboard.press
    press("i")
    press("ArrowRight")
    press("Shift+ArrowUp")
    *_, thrown = things(world)
    assert (thrown.x, thrown.y, thrown.vx, thrown.vy) == pytest.approx((0.1, 0, 0, 1))
    press("Control+z")
    assert things(world)[-1].vy == 0
    press("n")
    assert world.evaluate("arkanoid.part.chosen") == 0
    press("Delete")
    assert len(things(world)) == 2
    press(" ")
    wait_until(world, "part.runs && part.live.sandbox.record.time > 0.1")


def test_a_finger_throws_in(browser: Any, file: Path) -> None:
    """On a telephone, where nothing is wider than the screen."""
    with open_world(browser, file, STILL, **PHONE) as page:
        wait_until(page, "part.live")
        page.touchscreen.tap(*pixel(page, 0, 4))
        wait_until(page, "part.live.things().length === 3")
        assert page.evaluate("document.documentElement.scrollWidth") <= 390


@pytest.mark.parametrize("name", ["billiards", "pile", "world"])
def test_the_lines_of_python(browser: Any, file: Path, name: str) -> None:
    """They make the very world: run as they are, they print the hits that `World` has."""
    with open_world(browser, file, f"#world?scene={name}") as page:
        wait_until(page, "part.live")
        page.click("#world-python summary")
        wait_until(page, "document.querySelector('#world-python pre').textContent")
        program = page.locator("#world-python pre").text_content()
    assert all(len(line) <= 100 for line in program.splitlines())
    names: dict[str, Any] = {}
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(program.replace("range(600)", "range(60)"), names)
    scene = SCENES[name]
    world = make_world(scene.things)
    for _ in range(60):
        for handle, thing in enumerate(scene.things):
            if scene.gravity and thing.mass > 0:
                vx, vy = world.velocity(handle)
                world.place(handle, velocity=(vx, vy - scene.gravity * (1 / 60)))
        world.step(1 / 60)
    assert names["world"].positions.tobytes() == world.positions.tobytes()
    assert printed.getvalue()


def test_a_thousand_discs_are_links_too(browser: Any, file: Path) -> None:
    """There is room for 1024 bodies, and a sentence says when there is no more."""
    many = "&".join(f"b={text_of(Thing(x=i % 40 - 20, y=i // 40 - 13))}" for i in range(1030))
    with open_world(browser, file, f"#world?{many}") as page:
        wait_until(page, "part.live.things().length === 1024")
        assert "1024" in page.locator("#world-fault").text_content()


def test_the_lamp(browser: Any, file: Path) -> None:
    """It is dragged, and its rays end at what they meet first."""
    with open_world(browser, file, "#world?lamp=0,0&b=AxisAlignedRectangle,5,0,0,0,2,2") as page:
        wait_until(page, "part.live")
        first = "arkanoid.part.live.cast(arkanoid.part.lamp)[0]"
        ray = page.evaluate(f"{first}.plain()")
        assert ray["fraction"] * ray["way_x"] == pytest.approx(4)
        drag(page, (0, 0), (-3, 0.5))
        wait_until(page, "part.lamp[0] < -2.9")
        ray = page.evaluate(f"{first}.plain()")
        assert ray["fraction"] * ray["way_x"] == pytest.approx(7, abs=0.05)
        page.uncheck("#lamp")
        assert page.evaluate("arkanoid.part.lamp") is None


def focused(page: Any) -> tuple[str, str]:
    """Return role and name of what has the focus, as the browser tells those who can't see."""
    tree = page.context.new_cdp_session(page).send("Accessibility.getFullAXTree")
    *_, node = (
        node
        for node in tree["nodes"]
        for trait in node.get("properties", [])
        if trait["name"] == "focused" and trait["value"]["value"]
    )
    return node["role"]["value"], node["name"]["value"]


def test_the_lamp_by_keyboard(browser: Any, file: Path) -> None:
    """Only a pointer could move it: it had no keys, no name and no ring."""
    scene = "#world?lamp=0,0&b=AxisAlignedRectangle,5,0,0,0,2,2"
    with open_world(browser, file, scene, reduced_motion="reduce", **DESKTOP) as page:
        wait_until(page, "part.live && !part.runs")
        press = page.keyboard.press
        page.locator("#world-picture").focus()
        pass_pictures(page)
        before = page.locator("#world-picture").screenshot()
        press("Tab")
        pass_pictures(page)
        assert page.locator("#world-picture").screenshot() != before
        assert focused(page) == ("group", "Lamp at 0, 0")
        press("ArrowLeft")
        press("Shift+ArrowUp")
        assert page.evaluate("arkanoid.part.lamp") == [-0.1, 1]
        wait_until(page, "location.hash.includes('lamp=-0.1,1')")
        pass_pictures(page)
        assert focused(page) == ("group", "Lamp at −0.1, 1")
        for _ in range(12):
            press("Shift+ArrowUp")
        assert page.evaluate("arkanoid.part.lamp") == [-0.1, 8]
        press("n")
        press("ArrowRight")
        assert page.evaluate("arkanoid.part.lamp") == [-0.1, 8]
        assert things(page)[0].x == 5.1
        press("Tab")
        press("Delete")
        assert page.evaluate("arkanoid.part.lamp") is None
        assert not page.is_checked("#lamp")
        press("Control+z")
        assert page.evaluate("arkanoid.part.lamp") == [-0.1, 8]
        assert len(things(page)) == 1


def test_too_many_inside_sensors(browser: Any, file: Path) -> None:
    """A sentence says so; the world waits as it began, and goes on without the sensors."""
    discs = [Thing(x=i % 40 / 2 - 9.75, y=i // 40 / 2 - 6, width=0.1) for i in range(1000)]
    sensors = [Thing("AxisAlignedRectangle", width=40, height=30, mass=0, sensor=1)] * 5
    query = "&".join(f"b={text_of(thing)}" for thing in [*discs, *sensors])
    with open_world(browser, file, f"#world?{query}") as page:
        wait_until(page, "part.live && !part.runs")
        assert "sensors" in page.locator("#world-fault").text_content()
        page.evaluate(
            "arkanoid.part.live.handles().slice(1000).map(h => arkanoid.part.live.remove(h))"
        )
        page.click("#world-pause")
        wait_until(page, "part.live.sandbox.record.time > 0.1")
