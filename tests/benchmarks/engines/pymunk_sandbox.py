"""Chipmunk as a sandbox, through pymunk; with its defaults."""

import math
from collections.abc import Sequence
from typing import Any

import pymunk

from .sandbox import STEP, Pair


class PymunkSandbox:
    """Each body has one shape, which is the handle."""

    def __init__(self, gravity: float = 0.0, restitution: float = 1.0) -> None:
        self.space = pymunk.Space()
        self.space.gravity = (0.0, -gravity)
        self.restitution = restitution

    def _add(self, shape: pymunk.Shape) -> pymunk.Shape:
        shape.elasticity, shape.friction = self.restitution, 0.0
        self.space.add(shape.body, shape)
        return shape

    @staticmethod
    def _body(position: Pair, velocity: Pair) -> pymunk.Body:
        body = pymunk.Body(mass=1.0, moment=float("inf"))
        body.position, body.velocity = position, velocity
        return body

    def disc(self, position: Pair, velocity: Pair, radius: float) -> Any:
        return self._add(pymunk.Circle(self._body(position, velocity), radius))

    def crate(self, position: Pair, velocity: Pair, size: Pair) -> Any:
        return self._add(pymunk.Poly.create_box(self._body(position, velocity), size))

    def tile(self, position: Pair, size: Pair) -> Any:
        body = pymunk.Body(body_type=pymunk.Body.STATIC)
        body.position = position
        return self._add(pymunk.Poly.create_box(body, size))

    def remove(self, handle: Any) -> None:
        self.space.remove(handle.body, handle)

    def position(self, handle: Any) -> Pair:
        return tuple(handle.body.position)

    def velocity(self, handle: Any) -> Pair:
        return tuple(handle.body.velocity)

    def push(self, handle: Any, velocity: Pair) -> None:
        handle.body.velocity = velocity

    def step(self) -> None:
        self.space.step(STEP)

    def rays(self, rays: Sequence[tuple[Pair, Pair]]) -> list[float]:
        everything = pymunk.ShapeFilter()
        cast = self.space.segment_query_first
        fractions = []
        for start, end in rays:
            hit = cast(start, end, 0.0, everything)
            fractions.append(math.inf if hit is None else hit.alpha)
        return fractions


SANDBOX = PymunkSandbox
