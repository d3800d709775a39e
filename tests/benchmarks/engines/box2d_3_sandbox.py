"""Box2D 3.1 as a sandbox, through pyb2d3; with four sub-steps, as in its manual."""

import math
from collections.abc import Sequence
from typing import Any

import pyb2d3

from .sandbox import STEP, Pair


class Box2D3Sandbox:
    """Each body has one shape."""

    def __init__(self, gravity: float = 0.0, restitution: float = 1.0) -> None:
        self.world = pyb2d3.World(gravity=(0, -gravity), maximum_linear_speed=1e9)
        self.world.sleeping_enabled = False
        self.shape = pyb2d3.shape_def(
            density=1.0,
            material=pyb2d3.surface_material(restitution=restitution, friction=0.0),
        )

    def _dynamic(self, position: Pair, velocity: Pair) -> Any:
        return self.world.create_dynamic_body(
            position=position, linear_velocity=velocity, fixed_rotation=True, enable_sleep=False
        )

    def disc(self, position: Pair, velocity: Pair, radius: float) -> Any:
        body = self._dynamic(position, velocity)
        body.create_shape(self.shape, pyb2d3.circle(radius=radius))
        return body

    def crate(self, position: Pair, velocity: Pair, size: Pair) -> Any:
        body = self._dynamic(position, velocity)
        body.create_shape(self.shape, pyb2d3.box(size[0] / 2, size[1] / 2))
        return body

    def tile(self, position: Pair, size: Pair) -> Any:
        body = self.world.create_static_body(position=position)
        body.create_shape(self.shape, pyb2d3.box(size[0] / 2, size[1] / 2))
        return body

    def remove(self, handle: Any) -> None:
        handle.destroy()

    def position(self, handle: Any) -> Pair:
        return tuple(handle.position)

    def velocity(self, handle: Any) -> Pair:
        return tuple(handle.linear_velocity)

    def push(self, handle: Any, velocity: Pair) -> None:
        handle.linear_velocity = velocity

    def step(self) -> None:
        self.world.step(STEP, 4)

    def rays(self, rays: Sequence[tuple[Pair, Pair]]) -> list[float]:
        hits = []
        for (x, y), (to_x, to_y) in rays:
            hit = self.world.cast_ray_closest(origin=(x, y), translation=(to_x - x, to_y - y))
            hits.append(hit.fraction if hit.hit else math.inf)
        return hits


SANDBOX = Box2D3Sandbox
