"""Batches of tensors: which actions and devices they take, and what they say of others."""

import sys
from contextlib import nullcontext

import arkanoid  # noqa: F401
import numpy as np
import pytest
import torch
from arkanoid.envs import tensor_vector_env
from arkanoid.envs.batch.batch import Batch
from arkanoid.envs.config import Config
from arkanoid.envs.tensor_vector_env import ArkanoidTensorVectorEnv, read_device
from arkanoid.envs.tensors import running
from arkanoid.envs.tensors.batch import TensorBatch
from arkanoid.envs.tensors.entries import STEPS
from helpers.processes import run_program
from helpers.tensors import make

CPU = torch.device("cpu")


def batch(count=2, **keywords):
    host = Batch(count, Config.from_keywords(keywords))
    host.reset(np.ones(count, np.bool_), None, list(range(count)))
    tensors = TensorBatch(host, CPU)
    tensors.on_host(lambda: None)
    return tensors


class Foreign:
    """Numbers of another library, which are known by DLPack alone."""

    def __init__(self, tensor):
        self.tensor = tensor

    def __repr__(self):
        """A test's name is the same in each process."""
        return f"Foreign({self.tensor!r})"

    def __dlpack__(self, **keywords):
        return self.tensor.__dlpack__(**keywords)

    def __dlpack_device__(self):
        return self.tensor.__dlpack_device__()


@pytest.mark.parametrize(
    "actions",
    [
        [1, 2],
        (np.int8(1), np.int8(2)),
        np.array([1, 2], np.uint8),
        np.array([1, 2], np.uint64),
        np.array([2, 1])[::-1],
        np.broadcast_to(np.array([1, 2]), (3, 2))[0],
        torch.tensor([1, 2], dtype=torch.int32),
        torch.tensor([[1, 0], [2, 0]])[:, 0],
        torch.tensor([1, 2], dtype=torch.uint64),
        np.array([1, 2], ">i8"),
        [np.array(1), np.array(2)],
        Foreign(torch.tensor([1, 2])),
    ],
    ids=repr,
)
def test_integers_of_any_kind(actions):
    """What the processor's environment takes was refused: another order of bytes, lists of arrays.

    Torch also refuses arrays that are read backwards, and warns of those that can't be written.
    """
    one, other = batch(), batch()
    one.step(torch.tensor([1, 2]))
    other.step(actions)
    one.pull()
    other.pull()
    assert one.host.worlds.tobytes() == other.host.worlds.tobytes()


@pytest.mark.parametrize(
    ("actions", "error", "message"),
    [
        ([1], ValueError, r"must be 2 integers; got int64 of shape \(1,\)"),
        (torch.tensor([1]), ValueError, r"must be 2 integers; got torch.int64 of shape \(1,\)"),
        ([[1, 2]], ValueError, r"of shape \(1, 2\)"),
        (1, ValueError, r"of shape \(\)"),
        ([1.0, 2.0], ValueError, "got float64"),
        ([True, False], ValueError, "got bool"),
        (torch.tensor([True, False]), ValueError, "got torch.bool"),
        (torch.zeros(2, dtype=torch.complex64), ValueError, "got torch.complex64"),
        (["left", "right"], ValueError, "got <U5"),
        (None, ValueError, "got object"),
        (np.array([None, 1]), ValueError, "got object"),
        ([[1], [1, 2]], TypeError, r"is not in 2 integers, and no array"),
        (torch.tensor([1, 2]).to_sparse(), TypeError, r"dense tensor .* got torch.sparse_coo"),
        (torch.empty(2, dtype=torch.int64, device="meta"), TypeError, "got meta"),
        (Foreign(torch.tensor([1, 2], dtype=torch.complex64)), ValueError, "got torch.complex64"),
    ],
    ids=repr,
)
def test_other_forms_of_actions_are_refused(actions, error, message):
    """Some ended in errors of torch that say nothing of actions."""
    tensors = batch()
    with pytest.raises(error, match=message):
        tensors.step(actions)
    tensors.step([0, 0])


@pytest.mark.parametrize("actions", [[0, 0], [[True, False]] * 2, [[0.0, 0.0, 0.0]] * 2], ids=repr)
def test_other_forms_of_velocities_are_refused(actions):
    with pytest.raises(ValueError, match=r"must be numbers of shape \(2, 2\)"):
        batch(actions="box").step(actions)


def test_velocities_of_a_network_that_learns():
    """The batch would have held all of its gradients."""
    tensors = batch(actions="box")
    velocities = torch.zeros((2, 2), dtype=torch.float64, requires_grad=True)
    tensors.step(velocities * 2.0)
    assert not tensors._actions.requires_grad


def test_velocities_do_not_depend_on_how_torch_reads_lists(monkeypatch):
    """With another default of torch, 0.1 was rounded to three digits, or had no numbers at all."""
    one, other = batch(actions="box"), batch(actions="box")
    velocities = [[0.1, 1.0], [-0.3, 0.0]]
    one.step(np.array(velocities))
    torch.set_default_dtype(torch.float16)
    try:
        with torch.device("meta"):
            other.step(velocities)
    finally:
        torch.set_default_dtype(torch.float32)
    one.pull()
    other.pull()
    assert one.host.worlds.tobytes() == other.host.worlds.tobytes()


@pytest.mark.parametrize("device", ["tpu", "mps", "", "cuda:x"])
def test_unknown_devices(device):
    with pytest.raises(ValueError, match=r"must be 'cuda', 'cuda:1', ... or 'cpu'; got"):
        make(device, 1)


def test_what_is_no_device():
    with pytest.raises(TypeError, match=r"device must be 'cuda'.*got 0"):
        ArkanoidTensorVectorEnv(0)  # type: ignore[arg-type]


@pytest.fixture
def card(monkeypatch):
    """Pretend that there is one card, of a capability; return what sets it."""
    monkeypatch.setattr(torch.version, "cuda", "13.0")
    monkeypatch.setattr(torch.cuda, "is_available", lambda: True)
    monkeypatch.setattr(torch.cuda, "device_count", lambda: 1)
    monkeypatch.setattr(torch.cuda, "current_device", lambda: 0)
    monkeypatch.setattr(torch.cuda, "get_device_name", lambda device: "Tesla T4")
    monkeypatch.setattr(tensor_vector_env, "cuda_core", lambda: None)

    def set_capability(*capability):
        monkeypatch.setattr(torch.cuda, "get_device_capability", lambda device: capability)

    set_capability(9, 0)
    return set_capability


def test_devices_are_named_as_their_tensors_name_them(card):
    """``observation.device == env.device`` was wrong for "cuda"."""
    assert read_device("cuda") == read_device("cuda:0") == torch.device("cuda", 0)
    assert read_device(torch.device("cpu", 0)) == torch.device("cpu")


def test_a_torch_without_cuda(monkeypatch):
    monkeypatch.setattr(torch.version, "cuda", None)
    with pytest.raises(RuntimeError, match=r"this torch was built without CUDA .*pytorch.org"):
        make("cuda", 1)


def test_no_card(card, monkeypatch):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    with pytest.raises(
        RuntimeError,
        match=r"no NVIDIA card, or no driver that is new enough for CUDA 13\.0 .*without device",
    ):
        make("cuda", 1)


def test_no_such_card(card):
    with pytest.raises(RuntimeError, match="'cuda:1': there is 1 card, number 0"):
        make("cuda:1", 1)


def test_without_the_package_for_cards(card, monkeypatch):
    """It was missed only after the kernels had been compiled, for half a minute."""

    def missing():
        raise ImportError('pip install "arkanoid[gpu]" brings it')

    monkeypatch.setattr(tensor_vector_env, "cuda_core", missing)
    with pytest.raises(ImportError, match=r'pip install "arkanoid\[gpu\]"'):
        make("cuda", 1)


def test_an_old_card(card):
    card(7, 5)
    with pytest.raises(RuntimeError, match=r"Tesla T4 is too old: .*capability 8\.0"):
        make("cuda", 1)


def test_without_torch():
    program = """
import sys, gymnasium as gym, arkanoid
sys.modules["torch"] = None
try:
    gym.make_vec("Arkanoid-v0", vectorization_mode="vector_entry_point", device="cpu")
except ImportError as error:
    print(error)
"""
    assert (
        'pip install "arkanoid[gpu]" brings it' in run_program(program, warnings="default").stdout
    )


def test_games_as_arrays_import_no_torch():
    run_program(
        """
import sys, gymnasium as gym, arkanoid
gym.make_vec("Arkanoid-v0", vectorization_mode="vector_entry_point").reset(seed=0)
assert "torch" not in sys.modules
"""
    )


def test_too_little_memory(monkeypatch):
    def refuse(host, device):
        raise torch.OutOfMemoryError("CUDA out of memory")

    monkeypatch.setattr("arkanoid.envs.tensor_vector_env.TensorBatch", refuse)
    with pytest.raises(MemoryError, match="num_envs=3 does not fit into the memory of cpu"):
        make("cpu", 3)


def test_too_little_memory_for_the_threads_of_a_card(card, monkeypatch):
    """A card reserves their stacks when it runs kernels for the first time: in the first step."""

    class Kernels:
        def __init__(self, entries, number):
            pass

        def launcher(self, entry, threads):
            def refuse(*arguments):
                raise MemoryError("too little memory left for the game's kernels")

            return refuse

    monkeypatch.setattr(torch.cuda, "device", lambda device: nullcontext())
    stream = type("Stream", (), {"cuda_stream": 77})
    monkeypatch.setattr(torch.cuda, "current_stream", lambda device: stream)
    monkeypatch.setattr("arkanoid.physics.kernels.portable.cuda.CudaKernels", Kernels)
    run = running.Runs([STEPS["vector"][0].entry], torch.device("cuda", 0))
    with pytest.raises(torch.OutOfMemoryError, match="left for the game's kernels"):
        run.of(STEPS["vector"][0].entry, 32)(5, 4711)


def test_records_are_refused():
    with pytest.raises(NotImplementedError, match=r"without device=..., and restore a snapshot"):
        make("cpu", 1).record()


def test_runs_go_to_their_card(card, monkeypatch):
    """With another card in use, a run went to that one's default stream."""
    seen = []

    class InUse:
        def __init__(self, device):
            self.device = device

        def __enter__(self):
            seen.append(("in use", self.device.index))

        def __exit__(self, *exception):
            seen.append("as before")

    class Kernels:
        def __init__(self, entries, number):
            seen.append(("made", number))

        def launcher(self, entry, threads):
            return lambda *arguments: seen.append(arguments)

    monkeypatch.setattr(torch.cuda, "device", InUse)
    stream = type("Stream", (), {"cuda_stream": 77})
    monkeypatch.setattr(torch.cuda, "current_stream", lambda device: stream)
    monkeypatch.setattr("arkanoid.physics.kernels.portable.cuda.CudaKernels", Kernels)
    entry = STEPS["vector"][0].entry
    running.Runs([entry], torch.device("cuda", 2)).of(entry, 32)(5, 4711)
    around = ("in use", 2), "as before"
    assert seen == [around[0], ("made", 2), around[1], around[0], (5, 4711, 77), around[1]]
    assert "cuda" not in sys.modules
