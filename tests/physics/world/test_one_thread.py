"""A world or a batch belongs to one thread at a time."""

import copy
import threading
from collections.abc import Callable, Sequence
from typing import Any

import pytest
from arkanoid.physics import Body, Particle, World, WorldBatch
from arkanoid.physics.world.memory import stepper


def make_world() -> World:
    return World([Body(Particle(1.0), (0.0, 0.0), (1.0, 0.0), mass=1.0)])


def step_while_others_call(
    world: Any,
    calls: Sequence[Callable[[], Any]],
    attempt: Callable[[Any], None],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Step a world; in the middle of it, another thread attempts each of the calls."""
    plain = stepper.compiled_step()

    def meddle(address: int, count: int, dt: float, steps: int) -> Any:
        for call in calls:
            thread = threading.Thread(target=attempt, args=(call,))
            thread.start()
            thread.join()
        return plain(address, count, dt, steps)

    monkeypatch.setattr(stepper, "compiled_step", lambda: meddle)
    sites = [each.site for each in (world if isinstance(world, WorldBatch) else [world])]
    for site in sites:
        site.halt()
    world.step(1.0)
    monkeypatch.undo()
    for site in sites:
        site.halt()


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

    calls = (lambda: world.step(1.0), world.snapshot, lambda: world.restore(snapshot))
    step_while_others_call(world, calls, attempt, monkeypatch)
    assert len(errors) == 3 * max(1, threads)
    assert all("one thread at a time" in error for error in errors)
    assert world.positions.reshape(-1, 2)[0, 0] == 1.0
    world.restore(snapshot)
    assert world.positions.reshape(-1, 2)[0, 0] == 0.0


def test_questions_and_edits_are_refused_while_a_step_runs(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An edit gave up what the step wrote, and a question used the same memory."""
    world = make_world()
    world.add(Body(Particle(1.0), (9.0, 0.0)))
    third = world.add(Body(Particle(1.0), (99.0, 0.0)))
    calls: list[Callable[[], Any]] = [
        lambda: world.add(Body(Particle(1.0))),
        lambda: world.remove(third),
        lambda: world.change(0, mass=2.0),
        lambda: world.body(0),
        lambda: world.place(0, (5.0, 5.0)),
        lambda: world.place(1, position=(5.0, 5.0)),
        lambda: world.set_restitution(0, 1, 0.5),
        lambda: world.query_point((0.0, 0.0)),
        lambda: world.query_box((0.0, 0.0), (1.0, 1.0)),
        lambda: world.query_ray((0.0, 0.0), (1.0, 1.0)),
        lambda: world.query_rays([(0.0, 0.0)], [(1.0, 1.0)]),
        lambda: world.positions,
        lambda: world.velocities,
        lambda: WorldBatch(world, 2),
        lambda: copy.deepcopy(world),
    ]
    errors: list[str] = []

    def attempt(call: Any) -> None:
        with pytest.raises(RuntimeError) as caught:
            call()
        errors.append(str(caught.value))

    step_while_others_call(world, calls, attempt, monkeypatch)
    assert len(errors) == len(calls)
    assert all("one thread at a time" in error for error in errors)
    assert world.positions.tolist() == [[1.0, 0.0], [9.0, 0.0], [99.0, 0.0]]
    for call in calls:
        call()


def test_a_step_that_fails_leaves_the_world_free() -> None:
    world = make_world()
    world.place(0, velocity=(1e139, 0.0))
    with pytest.raises(ValueError, match="too large"):
        world.step(1e300)
    world.place(0, (0.0, 0.0), (1.0, 0.0))
    world.snapshot()
