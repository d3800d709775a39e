"""A world or a batch belongs to one thread at a time."""

import threading
from typing import Any

import pytest
from arkanoid.physics import Body, Particle, World, WorldBatch
from arkanoid.physics.world.states import Stepper


def make_world() -> World:
    return World([Body(Particle(1.0), (0.0, 0.0), (1.0, 0.0), mass=1.0)])


@pytest.mark.parametrize("threads", [0, 1, 2])
def test_a_second_thread_is_refused_while_a_step_runs(
    threads: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two steps at once wrote the same lists, and could index beyond their ends."""
    world: Any = make_world()
    if threads:
        world = WorldBatch(world, 4, threads=threads)
    snapshot = world.snapshot()
    errors: list[str] = []

    def attempt(call: Any) -> None:
        try:
            call()
        except RuntimeError as error:
            errors.append(str(error))

    plain = Stepper.step

    def meddle(stepper: Stepper, dt: float, steps: int) -> Any:
        for call in (lambda: world.step(1.0), world.snapshot, lambda: world.restore(snapshot)):
            thread = threading.Thread(target=attempt, args=(call,))
            thread.start()
            thread.join()
        return plain(stepper, dt, steps)

    monkeypatch.setattr(Stepper, "step", meddle)
    world.step(1.0)
    monkeypatch.undo()
    assert len(errors) == 3 * max(1, threads)
    assert all("one thread at a time" in error for error in errors)
    assert world.positions.reshape(-1, 2)[0, 0] == 1.0
    world.restore(snapshot)
    assert world.positions.reshape(-1, 2)[0, 0] == 0.0


def test_a_step_that_fails_leaves_the_world_free() -> None:
    world = make_world()
    world.place(0, velocity=(1e308, 0.0))
    with pytest.raises(ValueError, match="not finite"):
        world.step(1e300)
    world.place(0, (0.0, 0.0), (1.0, 0.0))
    world.snapshot()
