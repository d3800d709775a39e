"""Worlds in a browser: the bits of `World`, over edits, steps and questions."""

import base64
import json
import math
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arkanoid.envs.browser.manifest import make_manifest
from arkanoid.envs.browser.shipped import game_module
from arkanoid.envs.browser.worlds import MAX_HITS, ROOM
from arkanoid.physics import Body, Collider, World
from arkanoid.physics.kernels.one_thread import OneThread
from arkanoid.physics.scenes.patterns import POLYGONS, make_patterns, make_turns
from arkanoid.physics.scenes.placing import place_figure
from arkanoid.physics.scenes.ready import SCENES, Thing, collider_of, make_world
from arkanoid.physics.scenes.records import MAX_EDGES, RAYS, Figure
from arkanoid.physics.shapes.boundary import BoundaryEdge
from arkanoid.physics.shapes.records import Edge, Shape
from arkanoid.physics.shapes.table import shape_table
from arkanoid.physics.world.memory.setup import Room, Setup
from arkanoid.physics.world.memory.site import Family
from arkanoid.physics.world.state.records import Ray
from helpers.node import run_jobs
from helpers.repository import ROOT

SOURCES = ROOT / "envs" / "browser"
DT = 1 / 60
COLLIDERS = (
    *("Particle", "Particle", "Particle", "AxisAlignedRectangle", "Rectangle", "Convex"),
    "AxisAlignedHalfPlane",
)
SEEDS = range(16)
EDITS = 40


class Placed(Collider):
    """A collider with the very edges that the kernel of pages makes of a thing."""

    def __init__(self, thing: Thing) -> None:
        patterns, turns = _tables()
        shapes, pattern_edges = shape_table(patterns.values())
        name = f"Convex {thing.polygon}" if thing.collider == "Convex" else thing.collider
        figure = np.zeros(1, Figure)[0]
        figure.turn, figure.width, figure.height = thing.turn, thing.width, thing.height
        shape, edges = np.zeros(1, Shape), np.zeros(MAX_EDGES, Edge)
        row = list(patterns).index(name)
        place_figure(figure, shapes[row], pattern_edges, turns, shape[0], edges)
        self.kind = int(shape["kind"][0])
        self._edges = tuple(BoundaryEdge(*edge.tolist()) for edge in edges[: shape["count"][0]])
        self._rounding = float(shape["radius"][0])

    @property
    def edges(self) -> tuple[BoundaryEdge, ...]:
        return self._edges

    @property
    def rounding(self) -> float:
        return self._rounding


@cache
def _tables() -> tuple[dict[str, Collider], np.ndarray]:
    return make_patterns(), make_turns()


def shape_of(thing: Thing) -> Collider:
    """Return its collider; polygons with the page's edges, of which the last digits may differ."""
    return Placed(thing) if thing.collider == "Convex" else collider_of(thing)


def roomy_world() -> World:
    """Return an empty world with the room of a page's."""
    room = Room(bodies=ROOM, movers=ROOM, shapes=ROOM + 1, edges=MAX_EDGES * ROOM)
    family = Family([Setup(room, MAX_HITS, rest_speed=0.0, continuous=True)], [0])
    return World.at(family.sites[0], OneThread("this world"))


class Twin:
    """Does in Python what the page's module is told.

    Args:
        make: makes an empty world.
    """

    def __init__(self, make: Callable[[], World]) -> None:
        self._make = make
        self._done: list[list[Any]] = []
        self.clear()

    def do(self, job: list[Any]) -> list[float]:
        """Do a job; return its answer."""
        if job[0] == "restore":
            # A page has the very bytes again. A snapshot has no plans, and other plans may decide
            # otherwise in a heap. So all is done again.
            done = self._done[: self._done.index(["save"])]
            self._done = []
            for earlier in done:
                self.do(earlier)
            return []
        self._done.append(job)
        deed, *given = job
        answer: list[float] | None = None if deed == "save" else getattr(self, deed)(*given)
        return answer or []

    def clear(self) -> None:
        self.world = self._make()
        self.handles: list[int] = []

    def add(self, given: dict[str, Any]) -> list[float]:
        thing = Thing(**given)
        is_wall = thing.collider == "AxisAlignedHalfPlane"
        body = Body(
            shape_of(thing),
            (thing.x, thing.y),
            (thing.vx, thing.vy),
            None if is_wall else thing.mass or None,
            thing.restitution,
        )
        self.handles.append(self.world.add(body, sensor=bool(thing.sensor)))
        return [self.handles[-1]]

    def remove(self, body: int) -> None:
        self.world.remove(self.handles[body])

    def place(self, body: int, x: float, y: float, vx: float, vy: float) -> None:
        self.world.place(self.handles[body], (x, y), (vx, vy))

    def change(self, body: int, traits: dict[str, Any]) -> None:
        self.world.change(
            self.handles[body],
            mass=traits["mass"] or None,
            restitution=traits["restitution"],
            sensor=bool(traits["sensor"]),
        )

    def step(self, dt: float, gravity: float) -> list[float]:
        world = self.world
        for handle in world.handles if gravity else ():
            if world.body(handle).mass is not None:
                vx, vy = world.velocity(handle)
                world.place(handle, velocity=(vx, vy - gravity * dt))
        numbers: list[float] = []
        for hit in world.step(dt):
            numbers += [hit["kind"], hit["time"], hit["a"], hit["b"]]
            numbers += [*hit["normal"], *hit["point"], hit["impulse"]]
        for handle, place, speed in zip(
            world.handles, world.positions, world.velocities, strict=True
        ):
            numbers += [handle, *place, *speed]
        return [*numbers, world.time, world.capped]

    def find(self, x: float, y: float, reach: float) -> list[float]:
        if reach == 0:
            return self.world.query_point((x, y)).tolist()
        disc = collider_of(Thing(width=reach))
        return self.world._overlapping(disc, (x, y), -1).tolist()

    def cast(self, x: float, y: float, reach: float) -> list[float]:
        _, turns = _tables()
        rays = np.zeros(RAYS, Ray)
        rays["x"], rays["y"] = x, y
        rays["way_x"], rays["way_y"] = reach * turns[:: len(turns) // RAYS].T
        self.world._cast(rays, 0.0, -1)
        numbers = []
        for ray in rays:
            hit = ray["fraction"], ray["normal_x"], ray["normal_y"]
            numbers += [ray["body"], *(hit if ray["body"] >= 0 else ())]
        return numbers

    def sums(self, gravity: float) -> list[float]:
        bodies = [self.world.body(handle) for handle in self.world.handles]
        energy, momentum = 0.0, np.zeros(2)
        for body in bodies:
            if body.mass is not None:
                speed = body.velocity[0] * body.velocity[0] + body.velocity[1] * body.velocity[1]
                energy += body.mass * (0.5 * speed + gravity * body.position[1])
                momentum += body.mass * body.velocity
        return [energy, *momentum]


def random_thing(luck: np.random.Generator, collider: str | None = None) -> dict[str, Any]:
    collider = collider or str(luck.choice(COLLIDERS))
    moves = luck.random() < 0.75
    odd = luck.random() < 0.5
    return Thing(
        collider,
        *luck.uniform(-8, 8, 2),
        *(luck.uniform(-6, 6, 2) if moves else (0.0, 0.0)),
        width=float(luck.choice([0.0, 0.4, 1.0])) if collider == "Particle" else luck.uniform(1, 2),
        height=luck.uniform(0.5, 2),
        turn=int(luck.integers(360)) if odd else 90 * int(luck.integers(4)),
        mass=float(luck.choice([0.0, 1.0, 1.0, 2.5])),
        restitution=float(luck.choice([0.0, 0.5, 1.0, 1.0])),
        polygon=str(luck.choice(list(POLYGONS))),
        sensor=int(luck.random() < 0.15),
    )._asdict()


def random_jobs(seed: int) -> list[list[Any]]:
    """Return edits, steps and questions of a world between four walls."""
    luck = np.random.default_rng(seed)
    gravity = float(luck.choice([0.0, 0.0, 9.81]))
    jobs: list[list[Any]] = [["clear"]]
    walls = [thing for thing in SCENES["shapes"].things if thing.collider == COLLIDERS[-1]]
    jobs += [["add", wall._asdict()] for wall in walls]
    count = len(walls) + int(luck.integers(4, 25))
    jobs += [["add", random_thing(luck)] for _ in range(count - len(walls))]
    living = list(range(len(walls), count))
    for edit in range(EDITS):
        deed = str(luck.choice(["add", "remove", "place", "place", "change", "find", "cast"]))
        body = int(luck.choice(living)) if living else 0
        if deed == "add":
            jobs.append(["add", random_thing(luck)])
            living.append(count)
            count += 1
        elif deed == "remove" and living:
            living.remove(body)
            jobs.append(["remove", body])
        elif deed == "place" and living:
            speed = luck.uniform(-5, 5, 2) if luck.random() < 0.7 else (0.0, 0.0)
            jobs.append(["place", body, *luck.uniform(-8, 8, 2), *speed])
        elif deed == "change" and living:
            # What has no bounds keeps no mass.
            is_wall = [job for job in jobs if job[0] == "add"][body][1]["collider"] == COLLIDERS[-1]
            traits = {"mass": 0.0 if is_wall else float(luck.choice([0.0, 1.0, 3.0]))}
            traits |= {"restitution": float(luck.random()), "sensor": int(luck.random() < 0.3)}
            jobs.append(["change", body, traits])
        elif deed in ("find", "cast"):
            reach = float(luck.choice([0.0, 0.3])) if deed == "find" else 30.0
            jobs.append([deed, *luck.uniform(-10, 10, 2), reach])
        jobs += [["step", DT, gravity]] * int(luck.integers(1, 12))
        jobs.append(["sums", gravity])
        if edit == EDITS // 2:
            jobs.append(["save"])
    return [*jobs, ["restore"], *[["step", DT, gravity]] * 30]


def ready_jobs(name: str) -> list[list[Any]]:
    scene = SCENES[name]
    adds = [["add", thing._asdict()] for thing in scene.things]
    steps = 40 if name == "crowd" else 300
    return [["clear"], *adds, *[["step", DT, scene.gravity]] * steps, ["cast", 0.1, 0.2, 30.0]]


@cache
def all_jobs() -> dict[str, list[list[Any]]]:
    jobs = {f"random {seed}": random_jobs(seed) for seed in SEEDS}
    return jobs | {name: ready_jobs(name) for name in SCENES}


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[np.ndarray]]:
    """Return what the module of browsers says."""
    folder: Path = tmp_path_factory.mktemp("worlds")
    (folder / "module.wasm").write_bytes(game_module())
    (folder / "manifest.json").write_text(json.dumps(make_manifest({})), encoding="utf-8")
    files = folder / "module.wasm", folder / "manifest.json"
    flat = [job for jobs in all_jobs().values() for job in jobs]
    script = Path(__file__).with_name("throw.mjs")
    texts = iter(run_jobs(script, folder, flat, SOURCES, *files))
    return {
        name: [np.frombuffer(base64.b64decode(next(texts))) for _ in jobs]
        for name, jobs in all_jobs().items()
    }


@pytest.mark.filterwarnings("ignore::arkanoid.physics.HitLimitWarning")
@pytest.mark.parametrize("name", [*(f"random {seed}" for seed in SEEDS), *SCENES])
def test_the_bits_of_a_world(name: str, answers: dict[str, list[np.ndarray]]) -> None:
    """Handles, places, velocities, times, events, answers and sums: every bit.

    In a heap the room for touches decides; so random worlds have the page's in Python, too.
    """
    twin = Twin(World if name in SCENES else roomy_world)
    for number, (job, said) in enumerate(zip(all_jobs()[name], answers[name], strict=True)):
        expected = np.array(twin.do(job), np.float64)
        assert said.tobytes() == expected.tobytes(), (number, job)


def test_the_scenes_are_those_of_python() -> None:
    """What a user of Python makes of a scene has the page's shapes, to the last digits."""
    for scene in SCENES.values():
        world = make_world(scene.things)
        for handle, thing in enumerate(scene.things):
            own, there = world.body(handle).collider, Placed(thing)
            if thing.collider != "Convex":
                assert own.edges == there.edges, thing
            else:
                left = sorted(own.edges, key=lambda edge: math.atan2(edge[1], edge[0]))
                right = sorted(there.edges, key=lambda edge: math.atan2(edge[1], edge[0]))
                assert np.abs(np.array(left) - np.array(right)).max() < 1e-13


def test_a_scene_is_near_the_middle() -> None:
    """Nothing begins outside of the picture, and no two solid bodies overlap."""
    for name, scene in SCENES.items():
        world = make_world(scene.things)
        before = world.positions.copy()
        world.step(0.0)
        assert np.abs(world.positions - before).max() < 1e-9, name
        assert np.abs(before).max() <= 12.0
