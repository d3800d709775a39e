"""The operations on objects: users' classes, what is written back, and what is refused."""

import math
import pickle
from dataclasses import dataclass, field
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from arkanoid.physics import (
    AxisAlignedHalfPlane,
    AxisAlignedRectangle,
    Body,
    Collidable,
    Collider,
    Contact,
    Convex,
    Dynamic,
    HalfPlane,
    InseparableError,
    Moving,
    Particle,
    Rectangle,
    bounce,
    collide,
    contact,
    detect,
    relax,
    resolve,
    time_of_impact,
)


@dataclass
class Ghost:
    """A user's own class: it has what it needs and inherits nothing."""

    position: Any
    velocity: Any = (0.0, 0.0)
    mass: float | None = 1.0
    collider: Collider = field(default_factory=lambda: Particle(1.0))


class Wall:
    """Another one, with as little as possible: a collider, and a position that is read-only."""

    collider = AxisAlignedHalfPlane("+y")
    position = property(lambda self: (0.0, 0.0))


def test_users_classes_take_part() -> None:
    ghost, wall = Ghost((3.0, 0.5), (1.0, -2.0)), Wall()
    assert detect(ghost, wall)
    assert detect(wall, ghost)
    overlap = contact(ghost, wall)
    assert overlap is not None
    assert overlap.depth == 0.5
    assert overlap.normal.tolist() == [0, -1]
    assert overlap.point.tolist() == [3, -0.25]
    assert collide(ghost, wall)
    assert ghost.position == (3.0, 1.0)
    assert ghost.velocity == (1.0, 2.0)
    assert not detect(ghost, wall)
    assert not collide(ghost, wall)


def test_protocols_tell_what_an_object_can_do() -> None:
    ghost, wall = Ghost((0.0, 0.0)), Wall()
    body = Body(Particle(1))
    for item in (ghost, wall, body):
        assert isinstance(item, Collidable)
    assert isinstance(ghost, Dynamic)
    assert isinstance(body, Dynamic)
    assert not isinstance(wall, Moving)
    assert not isinstance(SimpleNamespace(position=(0, 0)), Collidable)


@pytest.mark.parametrize("kind", [tuple, list, np.array])
def test_positions_and_velocities_keep_their_type(kind: Any) -> None:
    old_position, old_velocity = kind([0, 0]), kind([1, 0])
    ghost = Ghost(old_position, old_velocity)
    assert collide(ghost, Ghost((1.5, 0.0), (-1.0, 0.0)))
    assert type(ghost.position) is type(old_position)
    assert list(ghost.position) == [-0.25, 0]
    assert list(ghost.velocity) == [-1, 0]
    # The old values do not change: others may refer to them.
    assert list(old_position) == [0, 0]
    assert list(old_velocity) == [1, 0]


def test_relaxation_shares_by_the_reciprocal_of_mass() -> None:
    a, b = Body(Particle(1), (0, 0), mass=3), Body(Particle(1), (1, 0), mass=1)
    overlap = contact(a, b)
    assert overlap is not None
    relax(a, b, overlap)
    assert a.position.tolist() == [-0.25, 0]
    assert b.position.tolist() == [1.75, 0]
    assert contact(a, b) is None
    assert a.velocity.tolist() == [0, 0]


def test_a_body_without_mass_stays() -> None:
    a, b = Body(Particle(1), (0, 0)), Body(Particle(1), (1, 0), mass=1e9)
    assert collide(a, b)
    assert a.position.tolist() == [0, 0]
    assert b.position.tolist() == [2, 0]
    c = Body(Particle(1), (1, 0))
    assert collide(a, c)
    assert detect(a, c)
    assert c.position.tolist() == [1, 0]


def test_a_bounce_returns_the_impulse() -> None:
    a = Body(Particle(1), (0, 0), (3, 1), mass=2)
    b = Body(Particle(1), (2, 0), (-1, 0), mass=2, restitution=0.5)
    # J = -(e + 1) (v1 - v2) / (1/m1 + 1/m2)
    assert bounce(a, b, (1, 0)) == -1.5 * 4 / 1
    assert a.velocity.tolist() == [0, 1]
    assert b.velocity.tolist() == [2, 0]
    # They separate now: nothing happens, along a normal of any length.
    assert bounce(a, b, (7, 0)) == 0
    assert bounce(a, b, (-7, 0), restitution=0) == pytest.approx(-2)
    assert a.velocity[0] == b.velocity[0]
    assert a.velocity[1] == 1


def test_restitution_is_the_product_unless_given() -> None:
    for given, expected in ((None, 0.125), (0.0, 0.0), (1.0, 1.0)):
        ball = Body(Particle(1), (0, 0), (0, -1), mass=1, restitution=0.5)
        floor = Body(AxisAlignedHalfPlane("+y"), restitution=0.25)
        bounce(ball, floor, (0, -1), given)
        assert ball.velocity.tolist() == [0, expected]
    plain = Ghost((0.0, 0.0), (0.0, -1.0))
    bounce(plain, Wall(), (0, -1))
    assert plain.velocity == (0.0, 1.0)


def test_resolving_relaxes_and_bounces() -> None:
    a = Body(Particle(1), (0, 0), (1, 0), mass=1)
    b = Body(AxisAlignedRectangle(2, 2), (1.5, 0))
    assert resolve(a, b) == -2
    assert a.position.tolist() == [-0.5, 0]
    assert a.velocity.tolist() == [-1, 0]
    assert resolve(a, b) == 0


def test_the_first_time_of_impact() -> None:
    a, b = Body(Particle(0.5), (0, 0), (4, 0)), Body(Particle(0.5), (10, 0), (-6, 0))
    impact = time_of_impact(a, b)
    assert impact is not None
    assert impact.time == 0.9
    assert impact.normal.tolist() == [1, 0]
    assert time_of_impact(a, b, 0.9) is not None
    assert time_of_impact(a, b, 0.89) is None
    assert time_of_impact(Wall(), Ghost((0.0, 5.0), (9.0, -2.0))) == (2.0, pytest.approx([0, 1]))
    assert time_of_impact(a, Wall()) == (0.0, pytest.approx([0, -1]))
    assert a.position.tolist() == [0, 0]


def test_relaxing_inseparable_regions_is_an_error() -> None:
    a, b = Body(HalfPlane((1, 1)), mass=1.0), Body(HalfPlane((1, 0)), (5, 5))
    assert detect(a, b)
    overlap = contact(a, b)
    assert overlap is not None
    assert overlap.depth == math.inf
    assert np.isfinite(overlap.normal).all()
    assert np.isfinite(overlap.point).all()
    assert time_of_impact(a, b) is not None
    for action in (
        lambda: relax(a, b, overlap),
        lambda: resolve(a, b),
        lambda: collide(a, b),
    ):
        with pytest.raises(InseparableError, match=r"HalfPlane.*from.*HalfPlane") as caught:
            action()
        assert (caught.value.a, caught.value.b) == (a, b)
    copy = pickle.loads(pickle.dumps(InseparableError("one", "other")))
    assert (copy.a, copy.b, str(copy)) == ("one", "other", str(InseparableError("one", "other")))


@pytest.mark.parametrize(
    ("item", "words"),
    [
        (object(), "needs a collider"),
        (SimpleNamespace(collider=Particle(1)), "needs a position"),
        (SimpleNamespace(collider="disc", position=(0, 0)), "a collider is needed"),
        (SimpleNamespace(collider=[], position=(0, 0)), "a collider is needed"),
        (SimpleNamespace(collider=Particle(1), position=("a", "b")), "must be a number"),
        (SimpleNamespace(collider=Particle(1), position=3), "position must be two numbers"),
    ],
)
def test_a_missing_attribute_is_named(item: Any, words: str) -> None:
    body = Body(Particle(1))
    for pair in ((item, body), (body, item)):
        for operation in (detect, contact, time_of_impact, collide):
            with pytest.raises(TypeError, match=words):
                operation(*pair)


def test_bad_values_are_refused() -> None:
    body = Body(Particle(1), mass=1)
    for position in ((0, 0, 0), (math.nan, 0), (math.inf, 0)):
        item = SimpleNamespace(collider=Particle(1), position=position)
        with pytest.raises(ValueError, match="position"):
            detect(body, item)
    for duration in (-1, math.nan):
        with pytest.raises(ValueError, match="duration must be 0 or more"):
            time_of_impact(body, body, duration)
    for normal in ((0, 0), (math.nan, 0), (1, 0, 0)):
        with pytest.raises(ValueError, match="normal"):
            bounce(body, body, normal)
    with pytest.raises(ValueError, match="restitution must not be negative"):
        bounce(body, body, (1, 0), -1)
    for mass in (0, -1, math.nan, math.inf, 5e-324):
        with pytest.raises(ValueError, match="mass"):
            bounce(Ghost((0.0, 0.0), mass=mass), body, (1, 0))
    heavy = SimpleNamespace(collider=Particle(1), position=(0, 0), mass=1)
    with pytest.raises(TypeError, match="needs a velocity"):
        bounce(heavy, body, (1, 0))


HUGE = 10**400


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda far, near: detect(far, near), r"position\[0\] is too large for a float"),
        (lambda far, near: contact(near, far), r"position\[0\] is too large for a float"),
        (
            lambda far, near: relax(far, near, Contact(np.array([1.0, 0.0]), 1.0, np.zeros(2))),
            r"position\[0\] is too large for a float",
        ),
        (lambda far, near: bounce(near, far, (HUGE, 0)), r"normal\[0\] is too large for a float"),
        (lambda far, near: bounce(near, far, (1, 0), HUGE), "restitution is too large for a float"),
        (lambda far, near: time_of_impact(near, near, HUGE), "duration is too large for a float"),
        (lambda far, near: Particle(HUGE), "radius is too large for a float"),
        (lambda far, near: Body(Particle(1), mass=Fraction(HUGE)), "mass is too large for a float"),
        (
            lambda far, near: detect(
                SimpleNamespace(collider=Particle(1), position=(10**308, 0)),
                SimpleNamespace(collider=Particle(1), position=(-(10**308), 0)),
            ),
            r"position must be at most 1e\+140 away from 0",
        ),
    ],
)
def test_integers_too_large_for_a_float_are_refused_by_name(call: Any, words: str) -> None:
    """There was an OverflowError that named nothing: int too large to convert to float."""
    far = SimpleNamespace(collider=Particle(1), position=(HUGE, 0), mass=1)
    with pytest.raises(ValueError, match=words):
        call(far, Body(Particle(1), mass=1))


def test_a_body_checks_and_copies_what_it_is_given() -> None:
    position = np.array([1, 2])
    body = Body(Particle(1), position, mass=2)
    position[0] = 9
    assert body.position.tolist() == [1, 2]
    assert body.position.dtype == body.velocity.dtype == np.float64
    body.position += (1, 1)
    body.velocity = [3, 4]
    assert body.position.tolist() == [2, 3]
    assert repr(body) == (
        "Body(Particle(radius=1.0), position=(2.0, 3.0), velocity=(3.0, 4.0), mass=2.0, "
        "restitution=1.0)"
    )
    for name, bad in (
        ("position", (math.nan, 0)),
        ("position", (1, 2, 3)),
        ("velocity", (math.inf, 0)),
        ("mass", 0),
        ("mass", -1),
        ("mass", math.inf),
        ("restitution", -0.1),
        ("restitution", math.nan),
    ):
        with pytest.raises(ValueError, match=name):
            Body(Particle(1), **{name: bad})
        with pytest.raises(ValueError, match=name):
            setattr(body, name, bad)
    with pytest.raises(TypeError, match="collider must be a collider"):
        Body("disc")  # type: ignore[arg-type]
    twin = pickle.loads(pickle.dumps(body))
    assert repr(twin) == repr(body)
    assert twin.position.tolist() == [2, 3]


# Published figures, by which engines are compared.


def box(width: float, height: float, *position: float, **more: Any) -> Body:
    return Body(AxisAlignedRectangle(width, height), position, **more)


def test_a_square_meets_a_thin_box_at_half_of_its_way() -> None:
    """Box [-1, 1]^2 against a box whose near face is at x = 2 and which moves by -2."""
    for square in (
        AxisAlignedRectangle(2, 2),
        Rectangle(2, 2, math.pi / 2),
        Convex([(-1, -1), (1, -1), (1, 1), (-1, 1)]),
    ):
        impact = time_of_impact(Body(square), box(0.5, 4, 2.25, 0, velocity=(-2, 0)))
        assert impact is not None
        assert impact.time == 0.5
        assert impact.normal.tolist() == [1, 0]


def test_a_point_flies_into_a_disc() -> None:
    """From (-4, 0) to (4, 0), against a disc of radius 1 about (1, 0)."""
    point = Body(Particle(0), (-4, 0), (8, 0))
    impact = time_of_impact(Body(Particle(1), (1, 0)), point)
    assert impact is not None
    assert impact.time == 0.5
    assert impact.normal.tolist() == [-1, 0]


@pytest.mark.parametrize(
    ("offset", "depth", "normal"),
    [((3.5, 0), 0.5, (1, 0)), ((0, 0.2), 1.8, (0, 1)), ((0, -0.2), 1.8, (0, -1))],
)
def test_boxes_separate_along_the_shorter_way(offset: Any, depth: float, normal: Any) -> None:
    for collider in (AxisAlignedRectangle(4, 2), Convex([(2, 1), (-2, 1), (-2, -1), (2, -1)])):
        overlap = contact(Body(collider), Body(collider, offset))
        assert overlap is not None
        assert overlap.depth == pytest.approx(depth, abs=1e-15)
        assert overlap.normal.tolist() == list(normal)


def test_two_discs_in_closed_form() -> None:
    overlap = contact(Body(Particle(10), (0, 0)), Body(Particle(10), (5, 3)))
    assert overlap is not None
    assert overlap.depth == pytest.approx(14.16904810, abs=1e-8)
    assert overlap.depth == pytest.approx(20 - math.sqrt(34), rel=1e-15)
    assert overlap.normal == pytest.approx([0.85749, 0.51450], abs=5e-6)
    assert overlap.point == pytest.approx([2.5, 1.5], rel=1e-15)


@pytest.mark.parametrize("corner", [(1, 1), (-1, 1), (-1, -1), (1, -1)])
@pytest.mark.parametrize(
    "square", [AxisAlignedRectangle(2, 2), Convex([(-1, -1), (1, -1), (1, 1), (-1, 1)])]
)
def test_a_disc_centred_on_a_corner(square: Collider, corner: Any) -> None:
    """The nearest point gives no direction out: the normal is that of one of the corner's faces."""
    disc, block = Body(Particle(0.5), corner, mass=1), Body(square)
    overlap = contact(disc, block)
    assert overlap is not None
    assert overlap.depth == 0.5
    assert sorted(map(abs, overlap.normal)) == [0, 1]
    assert overlap.normal @ np.array(corner) == -1
    assert collide(disc, block)
    assert not detect(disc, block)


def test_coincident_discs_separate() -> None:
    a, b = Body(Particle(1), (7, 7), mass=1), Body(Particle(2), (7, 7), mass=3)
    assert collide(a, b)
    assert np.linalg.norm(a.position - b.position) == 3
    assert contact(a, b) is None
    c = Body(Particle(1), (7, 7), mass=1)
    d = Body(Particle(1), (7, 7), mass=1)
    assert contact(c, d) == (pytest.approx([1, 0]), 2.0, pytest.approx([7, 7]))


def test_a_disc_in_the_concave_corner_of_two_boxes_reverses() -> None:
    """It meets both at once, bounces off both, and returns with exactly the opposite velocity."""
    ball = Body(Particle(0.5), (0, 0), (0.3, 0.7), mass=1)
    right, above = box(1, 9, 3, 0), box(9, 1, 0, 3)
    ball.position = (2 - 0.3 * 4, 2 - 0.7 * 4)
    for _ in range(2):
        impacts = [(time_of_impact(ball, wall), wall) for wall in (right, above)]
        first, wall = min((i, w) for i, w in impacts if i is not None)
        ball.position = ball.position + ball.velocity * first.time
        bounce(ball, wall, first.normal)
    assert ball.velocity.tolist() == [-0.3, -0.7]


@pytest.mark.parametrize("e", [1.0, 0.5, 0.0])
def test_two_discs_of_unequal_mass_through_their_first_impact(e: float) -> None:
    """Velocities along the line of centres follow the closed form; across it they stay."""
    a = Body(Particle(1), (0, 0), (5, 0), mass=2, restitution=e)
    b = Body(Particle(2), (10, 1.8), (-1, 0), mass=6)
    impact = time_of_impact(a, b)
    assert impact is not None
    distance = math.sqrt(9 - 1.8**2)
    assert impact.time == pytest.approx((10 - distance) / 6, rel=1e-15)
    n = np.array([distance, 1.8]) / 3
    assert impact.normal == pytest.approx(n, abs=1e-15)
    momentum = 2 * a.velocity + 6 * b.velocity
    u1, u2 = 5 * n[0], -1 * n[0]
    bounce(a, b, impact.normal)
    centre = (2 * u1 + 6 * u2) / 8
    assert a.velocity @ n == pytest.approx(centre + 6 / 8 * e * (u2 - u1), abs=1e-14)
    assert b.velocity @ n == pytest.approx(centre + 2 / 8 * e * (u1 - u2), abs=1e-14)
    across = np.array([-n[1], n[0]])
    assert a.velocity @ across == pytest.approx(5 * across[0], abs=1e-14)
    assert 2 * a.velocity + 6 * b.velocity == pytest.approx(momentum, abs=1e-14)
