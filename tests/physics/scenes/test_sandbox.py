"""The kernels of a page's world, called as a page calls them: what `World` says, also interpreted.

Browsers are compared with `World` in `envs/browser`, over many random worlds.
"""

from base64 import b64decode
from typing import Any

import numpy as np
import pytest
from arkanoid.envs.browser.worlds import describe_worlds
from arkanoid.physics.scenes.patterns import make_patterns, make_turns
from arkanoid.physics.scenes.ready import SCENES, Thing, make_world, text_of
from arkanoid.physics.scenes.records import RAYS, Sandbox, Seen
from arkanoid.physics.scenes.sandbox import (
    DONE,
    add_figure,
    begin_sandbox,
    find_figures,
    look_around,
    move_figure,
    remove_figure,
    see_sandbox,
    step_sandbox,
)
from arkanoid.physics.shapes.table import shape_table
from arkanoid.physics.world.state.records import Hit, Ray

DT = 1 / 60


class Page:
    """Memory as a page lays it out."""

    def __init__(self) -> None:
        described = describe_worlds()
        self.record = np.zeros(1, Sandbox)[0]
        self._memory: dict[str, Any] = {}
        for name, size in (described["blocks"] | described["tables"]).items():
            self._put(name, np.zeros(size, np.uint8))
        for name, size in described["blocks"].items():
            self.record[f"{name}_size"] = size
        header = np.frombuffer(b64decode(described["header"]), np.uint8)
        self._memory["workspace"][: len(header)] = header
        for name, number in described["numbers"].items():
            self.record[name] = number
        patterns = make_patterns()
        self._names = list(patterns)
        shapes, edges = shape_table(patterns.values())
        for name, table in (
            ("patterns", shapes),
            ("pattern_edges", edges),
            ("turns", make_turns()),
        ):
            self._put(name, table)
        self.record["number_of_patterns"] = len(shapes)
        self.record["number_of_edges"] = len(edges)
        begin_sandbox(self.record)

    def _put(self, name: str, array: np.ndarray) -> None:
        self._memory[name] = array
        self.record[name] = array.ctypes.data

    def add(self, thing: Thing) -> int:
        name = f"Convex {thing.polygon}" if thing.collider == "Convex" else thing.collider
        figure = self.record["figure"]
        figure["pattern"] = self._names.index(name)
        for field in ("x", "y", "vx", "vy", "width", "height", "turn", "mass", "restitution"):
            figure[field] = getattr(thing, field)
        self.record["sensor"] = thing.sensor
        add_figure(self.record)
        return int(self.record["handle"])

    def table(self, name: str, dtype: Any) -> np.ndarray:
        return self._memory[name].view(dtype)

    def bodies(self) -> np.ndarray:
        see_sandbox(self.record)
        return self.table("bodies", Seen)[: self.record["count"]]


@pytest.mark.parametrize("name", ["cradle", "billiards", "gate", "world"])
def test_a_scene(name: str) -> None:
    """Steps, hits, questions, an edit: every bit."""
    things = SCENES[name].things
    page, world = Page(), make_world(things)
    assert [page.add(thing) for thing in things] == world.handles.tolist()
    page.record["dt"] = DT
    for step in range(40):
        hits = world.step(DT)
        step_sandbox(page.record)
        assert page.record["outcome"] == DONE
        told = page.table("hits", Hit)[: page.record["count"]]
        order = np.argsort(told["time"], kind="stable")
        assert told[order].tobytes() == hits[np.argsort(hits["time"], kind="stable")].tobytes()
        if step == 20:
            last = int(world.handles[-1])
            world.place(last, (1.0, 1.0), (-2.0, 0.5))
            page.record["handle"] = last
            for field, number in zip(("x", "y", "vx", "vy"), (1.0, 1.0, -2.0, 0.5), strict=True):
                page.record["figure"][field] = number
            move_figure(page.record)
    bodies = page.bodies()
    seen = [bodies[part].tolist() for part in ("x", "y", "vx", "vy")]
    assert seen == [*world.positions.T.tolist(), *world.velocities.T.tolist()]
    for x, y in world.positions + 0.05:
        page.record["x"], page.record["y"], page.record["reach"] = x, y, 0.0
        find_figures(page.record)
        found = page.table("found", np.int64)[: page.record["count"]]
        assert found.tolist() == world.query_point((x, y)).tolist()


def test_rays_and_room() -> None:
    """Rays meet what `World` says; a removed body is met no more; the room has an end."""
    page = Page()
    box = Thing("AxisAlignedRectangle", 5, 0, width=2, height=2)
    first = page.add(box)
    page.record["x"], page.record["y"], page.record["reach"] = 0.0, 0.0, 8.0
    look_around(page.record)
    rays = page.table("rays", Ray)
    hit = make_world([box]).query_ray((0, 0), (8, 0))
    assert hit is not None
    assert (rays["body"][0], rays["fraction"][0]) == (hit.body, hit.fraction)
    assert rays["body"][RAYS // 2] == -1
    page.record["handle"] = first
    remove_figure(page.record)
    look_around(page.record)
    assert (rays["body"] == -1).all()
    remove_figure(page.record)
    assert page.record["handle"] == -1, "there is no such body any more"
    room = int(page.record["room"])
    handles = [page.add(Thing(width=0.0)) for _ in range(room + 1)]
    assert len(set(handles)) == room + 1
    assert handles[0] == 1 << 32, "its index serves again"
    assert handles[-1] == -1


def test_addresses_of_things() -> None:
    """Shortest texts, of the same bits; what is usual at the end is left out."""
    assert text_of(Thing()) == "Particle"
    assert (
        text_of(Thing("Rectangle", 0.1, -2, width=1.5, turn=30)) == "Rectangle,0.1,-2,0,0,1.5,1,30"
    )
    assert float(text_of(Thing(x=1 / 3)).split(",")[1]) == 1 / 3
