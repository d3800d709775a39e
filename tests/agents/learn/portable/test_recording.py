"""What recorded networks compute, number by number."""

import numpy as np
import pytest
import torch
from arkanoid.agents.learn.landing import LandingExtractor
from arkanoid.agents.learn.portable.recording import Numbers, Recording, UnknownOperationError
from arkanoid.agents.measure.landing import PARTS
from gymnasium import spaces
from helpers.networks import NativeNetwork

COUNTS = dict(zip(PARTS, (2, 3, 3, 3, 3, 3, 3), strict=True))


def computed(recording: Recording, results: Numbers, observations: np.ndarray) -> np.ndarray:
    """Return what the kernel computes, for each of some observations."""
    (count,) = results.shape
    recording.keep(np.zeros(1))  # a memory without weights is none
    header = {
        "sees": {"inputs": recording.inputs},
        "computed": recording.computed,
        "outputs": [results.first, count],
        "value": results.first,
    }
    weights = recording.weights.tobytes()
    network = NativeNetwork(header, recording.operations.tobytes(), weights)
    return np.array([network.judge(each)[:count] for each in observations], np.float32)


def layout() -> dict[str, tuple[int, int]]:
    places, start = {}, 0
    for name, count in COUNTS.items():
        places[name] = start, start + count
        start += count
    return places


def observations(count: int) -> np.ndarray:
    """Return vectors with balls that fly everywhere, are held, or are not there."""
    luck = np.random.default_rng(8)
    places = layout()
    seen = luck.uniform(-1.0, 1.0, (count, places["ball_vy"][1])).astype(np.float32)
    for name, share in (("ball_in_play", 0.7), ("ball_held", 0.2)):
        seen[:, slice(*places[name])] = luck.random((count, 3)) < share
    seen[::7, slice(*places["ball_vy"])] = 0.0
    # Some fall hardly, and so far to the side that they meet the walls thousands of times.
    seen[::11, slice(*places["ball_vy"])] *= 1e-6
    return seen


def test_landings_have_the_bits_of_torch() -> None:
    seen = observations(4000)
    space = spaces.Box(-1.0, 1.0, seen.shape[1:])
    extractor = LandingExtractor(space, layout(), 0.37)
    recording = Recording()
    results = extractor(recording.observe(seen.shape[1:]))
    found = computed(recording, results, seen)
    assert found.tobytes() == extractor(torch.from_numpy(seen)).numpy().tobytes()


@pytest.mark.parametrize(
    ("window", "stride", "padding"), [(3, 2, 1), (8, 4, 0), (4, 2, 0), (3, 1, 2), (1, 1, 0)]
)
def test_convolutions_of_whole_numbers_are_exact(window: int, stride: int, padding: int) -> None:
    """Sums of small whole numbers are not rounded, in whatever order they are taken."""
    luck = np.random.default_rng(window)
    layer = torch.nn.Conv2d(3, 5, window, stride, padding)
    for parameter in layer.parameters():
        parameter.data = torch.from_numpy(luck.integers(-9, 10, parameter.shape)).float()
    seen = luck.integers(-9, 10, (4, 3, 11, 14)).astype(np.float32)
    recording = Recording()
    results = layer(recording.observe(seen.shape[1:])).flatten(1, -1)
    found = computed(recording, results, seen)
    with torch.no_grad():
        assert (found == layer(torch.from_numpy(seen)).flatten(1, -1).numpy()).all()


@pytest.mark.parametrize("name", ["sin", "exp"])
def test_what_is_not_known_has_a_name(name: str) -> None:
    with pytest.raises(UnknownOperationError, match=name):
        getattr(torch, name)(Recording().observe((3,)))


def test_a_method_that_is_not_known_has_a_name() -> None:
    with pytest.raises(UnknownOperationError, match="cumsum"):
        Recording().observe((3,)).cumsum(1)


def test_convolutions_of_other_forms() -> None:
    with pytest.raises(UnknownOperationError, match="convolution"):
        torch.nn.Conv2d(2, 2, 3, groups=2)(Recording().observe((2, 5, 5)))
