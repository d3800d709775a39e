"""What finds things: the tree, the grid, restitutions of pairs, who is inside which sensor."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from arkanoid.physics import AxisAlignedRectangle, Body, Particle, World
from arkanoid.physics.world.lookup.neighbours import TOO_MANY
from arkanoid.physics.world.lookup.overrides import find_override, override_table
from arkanoid.physics.world.lookup.tree import clear_tree, find_leaves, insert_leaf, remove_leaf
from arkanoid.physics.world.state.records import Box, Entry, Node, Plan, Trait, Tree
from arkanoid.physics.world.state.view import LINKS, STACK
from hypothesis import given, settings
from hypothesis import strategies as st

SIDES = ("lower_x", "lower_y", "upper_x", "upper_y")


def crowd(count: int, radii: tuple[float, ...], speed: float = 1.0) -> list[Body]:
    """Return discs on a lattice, apart, that fly in all directions."""
    rng = np.random.default_rng(count)
    side, gap = math.ceil(math.sqrt(count)), 2.2 * max(radii)
    angles = rng.uniform(0, math.tau, count)
    return [
        Body(
            Particle(radii[index % len(radii)]),
            (index % side * gap, index // side * gap),
            (speed * math.cos(angle), speed * math.sin(angle)),
            mass=1,
        )
        for index, angle in enumerate(angles)
    ]


def plans_of(world: World) -> Any:
    return world.site.setup.records(world.site.state, "plans", Plan)


def touching(world: World) -> npt.NDArray[np.bool_]:
    """Return whose boxes touch or overlap, bool [movers, movers]; no body touches itself."""
    boxes = world.site.setup.records(world.site.state, "boxes", Box)
    lower = np.stack([boxes["lower_x"], boxes["lower_y"]], axis=1)
    upper = np.stack([boxes["upper_x"], boxes["upper_y"]], axis=1)
    both = ((lower[:, None] <= upper) & (lower <= upper[:, None])).all(axis=2)
    return np.asarray(both & ~np.eye(len(boxes), dtype=bool))


# The tree.


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from(["random", "sorted", "equal", "huge"]))
def test_the_tree_finds_what_brute_force_finds(seed: int, kind: str) -> None:
    """Boxes are put in, moved and taken out; the tree stays balanced."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 90))
    nodes, tree, stack = np.zeros(2 * count, Node), np.zeros(1, Tree)[0], np.zeros(STACK, np.int64)
    clear_tree(tree, nodes)
    inside: set[int] = set()
    for turn in range(4 * count):
        leaf = turn % count if kind == "sorted" else int(rng.integers(count))
        if leaf in inside:
            remove_leaf(tree, nodes, leaf)
            inside.remove(leaf)
        if turn < count or rng.random() < 0.7:
            size = 10 ** rng.uniform(-3, 300 if kind == "huge" else 1)
            low = np.zeros(2) if kind == "equal" else rng.normal(size=2) * 5
            low = np.full(2, float(turn)) if kind == "sorted" else low
            for name, value in zip(SIDES, (*low, *(low + size)), strict=True):
                nodes[leaf][name] = value
            insert_leaf(tree, nodes, leaf)
            inside.add(leaf)
        found = np.zeros(count, np.int64)
        low = rng.normal(size=2) * 5
        box = dict(zip(SIDES, (*low, *(low + 2)), strict=True))
        number = find_leaves(tree, nodes, *box.values(), stack, found, 0)
        expected = {
            leaf
            for leaf in inside
            if nodes[leaf]["lower_x"] <= box["upper_x"]
            and nodes[leaf]["upper_x"] >= box["lower_x"]
            and nodes[leaf]["lower_y"] <= box["upper_y"]
            and nodes[leaf]["upper_y"] >= box["lower_y"]
        }
        assert sorted(found[:number].tolist()) == sorted(expected)
        if len(inside) > 1:
            # The bound of an AVL tree with so many leaves (Knuth, vol. 3, 6.2.3, theorem A).
            assert nodes[tree["root"]]["height"] <= 1.4405 * math.log2(len(inside) + 1)


# The grid.


@pytest.mark.parametrize("place", [0.0, 1e6, -1e8])
@pytest.mark.parametrize("radii", [(0.5,), (0.5, 0.05), (0.5, *[0.02] * 9), (2.0, *[0.02] * 40)])
def test_a_crowd_is_followed_wherever_it_goes(radii: tuple[float, ...], place: float) -> None:
    """It left the grid, and each body was tested against each; large ones always were."""
    bodies = crowd(1000, radii)
    for body in bodies:
        body.position = body.position + place
    world = World(bodies)
    world.step(0.0)
    for _ in range(3):
        world.step(40.0)
        small = np.array([body.collider.rounding == min(radii) for body in bodies])
        assert touching(world)[small].sum(axis=1).mean() < 60


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([(0.5,), (0.5, 0.1), (2.0, *[0.1] * 20)]))
def test_lists_hold_the_bodies_whose_boxes_touch(seed: int, radii: tuple[float, ...]) -> None:
    """They are kept up to date while boxes change, bodies are placed, and lists are too long."""
    rng = np.random.default_rng(seed)
    world = World(crowd(60, radii))
    world.add(Body(AxisAlignedRectangle(3, 3), (-4, -4)))
    for _ in range(12):
        for body in rng.choice(60, 3).tolist():
            world.place(body, rng.uniform(-2, 12, 2), rng.normal(size=2))
        world.step(float(rng.choice([0.0, 0.1, 1.0])))
        list_type = np.dtype([("bodies", np.int64, LINKS)])
        links = world.site.setup.records(world.site.state, "links", list_type)
        due = touching(world)
        for slot, plan in enumerate(plans_of(world)):
            if plan["near"] != TOO_MANY:
                listed = links["bodies"][slot, plan["fixed"] : plan["near"]].tolist()
                assert sorted(listed) == np.flatnonzero(due[slot]).tolist()


def test_a_written_velocity_makes_few_plans_anew() -> None:
    """It made all of them anew."""
    world = World(crowd(900, (0.5,), speed=0.1))
    world.step(0.5)
    plans = plans_of(world)
    mark = 1e-200  # of a second: it decides nothing, and a new plan does not have it
    plans["time_low"] = mark
    world.step(0.0)
    assert (plans["time_low"] == mark).all()
    world.place(450, velocity=(0.3, 0.2))
    world.step(0.0)
    assert 1 <= (plans["time_low"] != mark).sum() <= 12
    plans["time_low"] = mark
    world.place(3, position=world.positions[3] + 0.001)
    world.step(0.0)
    assert 1 <= (plans["time_low"] != mark).sum() <= 12


@pytest.mark.parametrize("speed", [1e3, 1e9, 1e100, 1e139])
def test_a_body_of_any_speed_leaves_few_boxes(speed: float) -> None:
    """Each box is twice as large as the one before; cells of one size would never end."""
    bodies = [
        *crowd(20, (0.5,), speed=0.0),
        Body(Particle(0.1), (-3, -3), (-speed, -speed), mass=1),
    ]
    world = World(bodies)
    assert len(world.step(1.0)) == 0
    assert world.positions[20].tolist() == [-3 - speed, -3 - speed]


# Restitutions of pairs.


@settings(max_examples=30, deadline=None)
@given(
    st.dictionaries(
        st.tuples(st.integers(0, 40), st.integers(41, 2**31)), st.floats(0, 2), max_size=60
    ),
    st.integers(0, 10**6),
)
def test_restitutions_of_pairs_are_found(pairs: dict[tuple[int, int], float], seed: int) -> None:
    table = override_table((*pair, pairs[pair]) for pair in pairs)
    for (low, high), restitution in pairs.items():
        assert find_override(table, low, high) == restitution
    rng = np.random.default_rng(seed)
    for low, high in rng.integers((0, 41), (41, 200), (50, 2)).tolist():
        if (low, high) not in pairs:
            assert math.isnan(find_override(table, low, high))


# Sensors.


def test_sensors_cost_what_is_inside() -> None:
    """A snapshot held a byte for each sensor and each body: 13 MB for 1000 and 10 000."""
    world = World(crowd(300, (0.1,), speed=0.01))
    plain = len(world.snapshot())
    for index in range(200):
        world.add(Body(AxisAlignedRectangle(0.5, 0.5), (index, -5)), sensor=True)
    world.step(0.0)
    of_bodies = 200 * (Trait.itemsize + Entry.itemsize)
    assert len(world.snapshot()) == plain + of_bodies
    world.change(499, active=False)
    world.place(499, world.positions[150])
    before = len(world.snapshot())
    world.change(499, active=True)
    entered = world.step(0.0)
    assert set(entered["b"]) == {499}
    assert len(world.snapshot()) == before + 24 * len(entered)


def test_queries_before_the_first_step_find_the_same_when_cells_change() -> None:
    """The cells were chosen again, to suit the bodies, but the grid kept those from before.

    They depend on how far bodies are apart: also on those that are off, and not in the grid.
    """
    places = [(10 * (index % 5), 10 * (index // 5)) for index in range(25)]
    world = World([Body(Particle(1), place, (1, 0), 1) for place in places])
    others = [world.add(Body(Particle(1), (20, 20))) for _ in range(50)]
    for other in others:
        world.change(other, active=False)
    for far in (20, 1e4):
        for index, other in enumerate(others):
            world.place(other, (far * (index % 7), far * (index // 7)))
        assert [world.query_point(place).tolist() for place in places] == [[i] for i in range(25)]
