"""The collision playground in a real browser."""

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from arkanoid.physics import Body, Particle, Rectangle, bounce, contact, relax, time_of_impact
from helpers.browser import DESKTOP, PHONE, visit, wait_until
from helpers.repository import ROOT

MARKUP = (ROOT / "agents" / "browser" / "markup" / "collide.html").read_text(encoding="utf-8")
SCENES = [link.replace("&amp;", "&") for link in re.findall(r'href="(#collide[^"]*)"', MARKUP)]
SITE = (ROOT / "docs" / "site" / "playable.py").read_text(encoding="utf-8")
SCENES += [f"#collide?{scene}" for scene in re.findall(r'"\w+": "(a=[^"]*)"', SITE)]
OVERLAPPING = (
    "#collide?a=Particle,-0.35,-0.45,0.5,0,0.9,1,0,1&b=Particle,0.45,0.25,-1,0,0.9,1,0,3,0.5"
)
FLYING = "#collide?a=Rectangle,-2,0,2,0.5,2,1,30,2&b=Particle,2,1,-1,-0.5,0.75,1,0,1,0.5"
APART = "#collide?a=Particle,-3,0,1,1&b=Particle,3,0"


@pytest.fixture
def scene(browser: Any, file: Path) -> Iterator[Any]:
    """Return the page with two bodies that are apart."""
    with visit(browser, file.as_uri() + APART, **DESKTOP) as page:
        yield page


def says(page: Any, name: str) -> str:
    return page.locator(f"[data-says={name}]").text_content()


def numbers(text: str) -> list[float]:
    return [float(word) for word in re.findall(r"-?[\d.]+", text.replace("−", "-"))]


def bodies(page: Any) -> dict[str, Any]:
    return page.evaluate("structuredClone(arkanoid.part.bodies)")


def drag(page: Any, target: str, units: tuple[float, float]) -> None:
    """Drag the middle of an element by so many units of the scene."""
    box = page.locator(target).bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    unit = page.evaluate("document.querySelector('#collisions .marks').getScreenCTM().a")
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 3, y, steps=2)
    page.mouse.move(x + unit * units[0], y - unit * units[1], steps=4)
    page.mouse.up()


def test_values_of_an_overlap(browser: Any, file: Path) -> None:
    """They are those of Python's functions, and its button does what it says."""
    a = Body(Particle(0.9), (-0.35, -0.45), (0.5, 0), mass=1)
    b = Body(Particle(0.9), (0.45, 0.25), (-1, 0), mass=3)
    found = contact(a, b)
    assert found is not None
    relax(a, b, found)
    with visit(browser, file.as_uri() + OVERLAPPING, **DESKTOP) as page:
        assert says(page, "detect") == "They overlap."
        assert says(page, "algorithm") == "disc-disc"
        assert numbers(says(page, "normal")) == pytest.approx(found.normal, rel=1e-4)
        assert numbers(says(page, "depth")) == pytest.approx([found.depth], rel=1e-4)
        assert numbers(says(page, "point")) == pytest.approx(found.point, rel=1e-3, abs=1e-4)
        assert numbers(says(page, "share_a")) == [0.75]
        assert page.locator("#collisions .relaxed").count() == 2
        page.get_by_role("button", name="Relax").click()
        assert says(page, "detect") == "They do not overlap."
        moved = bodies(page)
        for side, body in (("a", a), ("b", b)):
            assert [moved[side]["x"], moved[side]["y"]] == body.position.tolist()


def test_a_flight_and_a_bounce(browser: Any, file: Path) -> None:
    a = Body(Rectangle(2, 1, math.radians(30)), (-2, 0), (2, 0.5), mass=2)
    b = Body(Particle(0.75), (2, 1), (-1, -0.5), mass=1, restitution=0.5)
    impact = time_of_impact(a, b)
    assert impact is not None
    with visit(browser, file.as_uri() + FLYING, **DESKTOP) as page:
        assert numbers(says(page, "time")) == pytest.approx([impact.time], rel=1e-4)
        assert numbers(says(page, "impact_normal")) == pytest.approx(impact.normal, rel=1e-4)
        assert page.locator("#collisions .impact").count() == 2
        assert page.locator("#collisions .bounced").count() == 2
        assert page.get_by_role("button", name="Bounce").is_disabled()
        page.get_by_role("button", name="Fly there").click()
        impulse = bounce(a, b, impact.normal)
        assert numbers(says(page, "time")) == [0]
        assert numbers(says(page, "impulse")) == pytest.approx([impulse], rel=1e-4)
        page.keyboard.press("Enter")  # the focus goes on to the next button
        bounced = bodies(page)
        for side, body in (("a", a), ("b", b)):
            velocity = [bounced[side]["vx"], bounced[side]["vy"]]
            assert velocity == pytest.approx(body.velocity, abs=1e-12)


def test_dragging(scene: Any) -> None:
    drag(scene, "#collisions .regions .a", (2, 1))
    drag(scene, "#collisions .handle.b .tip", (-1.5, 0.5))
    moved = bodies(scene)
    assert [moved["a"]["x"], moved["a"]["y"]] == pytest.approx([-1, 1], abs=0.02)
    assert [moved["b"]["vx"], moved["b"]["vy"]] == pytest.approx([-1.5, 0.5], abs=0.02)
    assert scene.get_by_role("radio", name="Body b").is_checked()
    wait_until(scene, "location.hash.includes('b=Particle,3,0,-1.5')")
    scene.reload()
    wait_until(scene, "globalThis.arkanoid")
    assert bodies(scene) == moved


def test_typing(scene: Any) -> None:
    """Numbers, shapes, missing edges; what can't be is put right."""
    scene.get_by_role("radio", name="Body a").check()
    scene.locator("#panel-collide").get_by_label("Collider").select_option("Convex")
    scene.locator("#panel-collide").get_by_label("Polygon").select_option("triangle")
    scene.locator("#panel-collide").get_by_label("2", exact=True).check()
    scene.locator("#panel-collide").get_by_label("0", exact=True).check()
    assert scene.locator("#panel-collide").get_by_label("1", exact=True).is_disabled()
    field = scene.locator("#panel-collide").get_by_label("position x")
    field.fill("-1.25")
    scene.locator("#panel-collide").get_by_label("mass").fill("-4")
    scene.locator("#panel-collide").get_by_label("mass").blur()
    assert scene.locator("#panel-collide").get_by_label("mass").input_value() == "1"
    scene.locator("#panel-collide").get_by_label("static").check()
    scene.locator("#panel-collide").get_by_label("rotation").fill("45")
    scene.get_by_role("button", name="Turn counterclockwise").click()
    body = bodies(scene)["a"]
    expected = {"collider": "Convex", "polygon": "triangle", "open": "02", "x": -1.25}
    assert body.items() >= (expected | {"mass": 0, "turn": 60}).items()
    wait_until(scene, "location.hash.includes('triangle,02')")
    scene.locator("#panel-collide").get_by_label("Polygon").select_option("pentagon")
    assert bodies(scene)["a"]["open"] == ""


def test_keys_alone(scene: Any) -> None:
    scene.keyboard.press("Tab")
    scene.locator("nav a").last.focus()
    scene.keyboard.press("Tab")
    scene.keyboard.press("ArrowRight")
    scene.keyboard.press("Alt+ArrowUp")
    scene.keyboard.press("Shift+ArrowUp")
    scene.keyboard.press("Tab")
    scene.get_by_role("radio", name="Body b").focus()
    scene.locator("#panel-collide").get_by_label("Collider").select_option("Rectangle")
    scene.locator("#collisions .regions .b").focus()
    scene.keyboard.press("Shift+ArrowLeft")
    scene.locator("#collisions .handle.b .tip").focus()
    scene.keyboard.press("ArrowDown")
    moved = bodies(scene)
    a, b = moved["a"], moved["b"]
    assert (a["x"], a["y"], a["width"]) == (-2.9, 0.01, 1.1)
    assert (b["turn"], b["vy"]) == (5, -0.1)


def test_scenes(scene: Any) -> None:
    """Each opens, and its address is written as it is read; so does one that makes no sense."""
    for link in [*SCENES, "#collide?a=Blob,x,1e999,,,-3&b=&c=Particle"]:
        scene.evaluate(f"location.hash = {link!r}")
        wait_until(scene, f"location.hash === {link!r} && part.opened === {link!r}")
        scene.evaluate("arkanoid.part.change('a', { restitution: 0.75 })")
        shown = bodies(scene)
        assert scene.locator("#collisions .regions :is(polygon, circle)").count() == 2
        wait_until(scene, "location.hash.includes(',0.75')")
        scene.reload()
        wait_until(scene, "globalThis.arkanoid")
        assert bodies(scene) == shown
    assert shown["a"]["collider"] == shown["b"]["collider"] == "Particle"


def test_other_parts_come_back(scene: Any) -> None:
    scene.get_by_role("link", name="Play", exact=True).click()
    wait_until(scene, "part.game")
    assert scene.locator("#picture").is_visible()
    assert not scene.locator("#collisions").is_visible()
    scene.get_by_role("link", name="Collide").click()
    wait_until(scene, "part.scene")
    assert bodies(scene)["a"]["x"] == -3


def test_on_a_phone(browser: Any, file: Path) -> None:
    """Nothing is wider than the screen, and the picture stays while one changes numbers."""
    with visit(browser, file.as_uri() + APART, **PHONE) as page:
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        field = page.locator("#panel-collide").get_by_label("restitution")
        field.scroll_into_view_if_needed()
        field.fill("0.25")
        assert page.locator("#collisions").bounding_box()["y"] >= 0
        assert bodies(page)["b"]["restitution"] == 0.25
        box = page.locator("#collisions .regions .b").bounding_box()
        page.touchscreen.tap(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
