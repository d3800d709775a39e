"""Bounces conserve momentum and energy, exactly along the axes, and never drift."""

import math
from typing import Any

import numba
import numpy as np
import pytest
from arkanoid.physics.pairs.response import bounce_velocities, reflect, shares
from hypothesis import given, settings
from hypothesis import strategies as st

speeds = st.floats(-1e9, 1e9)
masses = st.floats(1e-6, 1e6)
angles = st.floats(0, 2 * math.pi)
restitutions = st.floats(0, 1)


def unit(angle: float) -> tuple[float, float]:
    return math.cos(angle), math.sin(angle)


@given(speeds, speeds, st.sampled_from([(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)]))
def test_an_axis_aligned_wall_reverses_one_component_exactly(
    vx: float, vy: float, normal: tuple[float, float]
) -> None:
    expected = (-vx, vy) if normal[0] else (vx, -vy)
    assert reflect(vx, vy, *normal, 1.0) == expected
    x, y, wall_x, wall_y, impulse = bounce_velocities(vx, vy, 0, 0, 0.25, 0.0, *normal, 1.0)
    approaching = vx * normal[0] + vy * normal[1] > 0
    assert (x, y) == (expected if approaching else (vx, vy))
    assert (wall_x, wall_y) == (0, 0)
    assert impulse == (-2 * (vx * normal[0] + vy * normal[1]) / 0.25 if approaching else 0)


@given(*[speeds] * 4, masses, masses, angles, restitutions)
def test_a_bounce_conserves_momentum_and_gives_back_its_share_of_speed(
    v1x: float,
    v1y: float,
    v2x: float,
    v2y: float,
    m1: float,
    m2: float,
    angle: float,
    e: float,
) -> None:
    n = unit(angle)
    w1x, w1y, w2x, w2y, impulse = bounce_velocities(v1x, v1y, v2x, v2y, 1 / m1, 1 / m2, *n, e)
    approach = (v1x - v2x) * n[0] + (v1y - v2y) * n[1]
    speed = max(map(abs, (v1x, v1y, v2x, v2y, 1e-300)))
    if approach <= 0:
        assert (w1x, w1y, w2x, w2y, impulse) == (v1x, v1y, v2x, v2y, 0)
        return
    # The formula of the lecture on collisions in games, word for word.
    assert impulse == pytest.approx(-(e + 1) * approach / (1 / m1 + 1 / m2), rel=1e-12)
    scale = (m1 + m2) * speed
    for before, after, share in (
        (m1 * v1x + m2 * v2x, m1 * w1x + m2 * w2x, n[0]),
        (m1 * v1y + m2 * v2y, m1 * w1y + m2 * w2y, n[1]),
    ):
        assert after == pytest.approx(before, abs=1e-14 * scale)
        assert abs(share) <= 1
    assert (w1x - v1x) * m1 == pytest.approx(impulse * n[0], abs=1e-13 * scale)
    parting = (w2x - w1x) * n[0] + (w2y - w1y) * n[1]
    assert parting == pytest.approx(e * approach, abs=1e-13 * speed * max(m1 / m2, m2 / m1, 1))
    if e == 1:
        energy = m1 * (v1x**2 + v1y**2) + m2 * (v2x**2 + v2y**2)
        after = m1 * (w1x**2 + w1y**2) + m2 * (w2x**2 + w2y**2)
        assert after == pytest.approx(energy, rel=1e-12)


@given(*[speeds] * 4, masses, angles)
def test_swapping_the_bodies_swaps_a_bounce(
    v1x: float, v1y: float, v2x: float, v2y: float, mass: float, angle: float
) -> None:
    n = unit(angle)
    one = bounce_velocities(v1x, v1y, v2x, v2y, 1 / mass, 0.5, *n, 0.75)
    other = bounce_velocities(v2x, v2y, v1x, v1y, 0.5, 1 / mass, -n[0], -n[1], 0.75)
    assert one == (other[2], other[3], other[0], other[1], other[4])


@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
def test_two_discs_of_unequal_mass_in_closed_form(e: float) -> None:
    """Head on: v1' = ((m1 - e m2) v1 + (1 + e) m2 v2) / (m1 + m2), and the same for 2."""
    m1, m2, v1, v2 = 3.0, 5.0, 4.0, -2.0
    w1, _, w2, _, _ = bounce_velocities(v1, 0.0, v2, 0.0, 1 / m1, 1 / m2, 1.0, 0.0, e)
    assert w1 == pytest.approx(((m1 - e * m2) * v1 + (1 + e) * m2 * v2) / (m1 + m2), rel=1e-15)
    assert w2 == pytest.approx(((m2 - e * m1) * v2 + (1 + e) * m1 * v1) / (m1 + m2), rel=1e-15)


def test_a_body_without_mass_does_not_yield() -> None:
    assert bounce_velocities(1, 2, -3, 4, 0, 0, 1, 0, 1) == (1, 2, -3, 4, 0)
    # A static body that moves by itself, such as a paddle, passes on its speed.
    assert bounce_velocities(0, 0, -3, 4, 0.5, 0, 1, 0, 1)[:4] == (-6, 0, -3, 4)


def test_there_is_no_threshold_below_which_nothing_bounces() -> None:
    assert bounce_velocities(1e-300, 0, 0, 0, 1, 0, 1, 0, 1)[0] == -1e-300


@given(masses, masses)
def test_shares_are_reciprocal_to_mass(m1: float, m2: float) -> None:
    one, other = shares(1 / m1, 1 / m2)
    assert one == pytest.approx(m2 / (m1 + m2), rel=1e-14)
    assert one + other == pytest.approx(1, rel=1e-15)
    assert shares(1 / m1, 0.0) == (1, 0)
    assert shares(0.0, 1 / m2) == (0, 1)
    assert shares(0.0, 0.0) == (0, 0)


@numba.njit  # type: ignore[untyped-decorator]
def bounce_around(normals: Any, vx: float, vy: float, bounces: int) -> tuple[float, float]:
    """Reflect a velocity off walls in turn, as a ball in a polygon would."""
    for i in range(bounces):
        normal = normals[i % len(normals)]
        vx, vy = reflect(vx, vy, normal[0], normal[1], 1.0)
    return vx, vy


def test_a_million_bounces_off_axis_aligned_walls_keep_the_energy_to_the_bit() -> None:
    normals = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    assert bounce_around(normals, 0.1234, -0.5678, 1_000_000) == (0.1234, -0.5678)
    assert bounce_around(normals, 0.1234, -0.5678, 1_000_001) == (-0.1234, -0.5678)


@settings(max_examples=20, deadline=None)
@given(st.lists(angles, min_size=1, max_size=7), angles)
def test_a_million_bounces_off_slanted_walls_do_not_drift(
    walls: list[float], heading: float
) -> None:
    """A normal is a unit vector only up to rounding. The same error must not accumulate."""
    vx, vy = unit(heading)
    wx, wy = bounce_around(np.array([unit(wall) for wall in walls]), vx, vy, 1_000_000)
    assert wx * wx + wy * wy == pytest.approx(vx * vx + vy * vy, rel=1e-9)
