"""Kernels on a card, with a stand-in for NVIDIA's package: what it is asked for, and its errors."""

import builtins
from types import SimpleNamespace

import pytest
from arkanoid.physics.kernels.portable import Entry, cuda

ENTRY = Entry("module", "step")


class Core:
    """The part of cuda-core that is used; it notes what it is asked for."""

    def __init__(self, error=None):
        self.calls = []
        self.refuses = None  # the error of a launch
        self.ObjectCode = SimpleNamespace(from_ptx=lambda text: self._code(text, error))
        self.Stream = SimpleNamespace(from_handle=lambda handle: self._note("stream", handle))
        self.LaunchConfig = lambda grid, block: (grid, block)

    def _note(self, *call):
        self.calls.append(call)
        return call

    def _code(self, text, error):
        if error is not None:
            raise error
        return SimpleNamespace(get_kernel=lambda name: (text, name))

    def Device(self, card):  # noqa: N802
        return SimpleNamespace(set_current=lambda: self._note("card", card))

    def launch(self, *arguments):
        self._note("launch", *arguments)
        if self.refuses is not None:
            raise self.refuses


@pytest.fixture
def card(monkeypatch):
    """Return what puts a stand-in in place, and makes the kernels of card 1."""
    monkeypatch.setattr(cuda, "make_ptx", lambda entries: "the PTX")

    def make(error=None):
        core = Core(error)
        monkeypatch.setattr(cuda, "cuda_core", lambda: core)
        return core, cuda.CudaKernels([ENTRY], 1)

    return make


def test_as_many_blocks_as_there_are_items(card):
    core, kernels = card()
    assert core.calls == [("card", 1)]
    launch = kernels.launcher(ENTRY, 32)
    kernel = (b"the PTX", "step_kernel")
    for count, blocks in ((1, 1), (32, 1), (33, 2), (4096, 128)):
        del core.calls[:]
        launch(count, 4711, 5)
        assert core.calls[-1] == ("launch", ("stream", 5), (blocks, 32), kernel, count, 4711)
    # A stream is made once.
    assert [call[0] for call in core.calls] == ["launch"]


def test_a_card_that_refuses(card):
    with pytest.raises(RuntimeError, match=r"card 1 refuses .*\(no binary for it\).*8\.0.*driver"):
        card(ValueError("no binary for it"))


OUT = RuntimeError("CUDA_ERROR_OUT_OF_MEMORY: The API call failed")


def test_a_card_without_room(card):
    """It was told to be too old, or in the first step an error of the driver came."""
    message = r"card 1 has too little memory left .*CUDA_ERROR_OUT_OF_MEMORY.*take fewer games"
    with pytest.raises(MemoryError, match=message):
        card(OUT)
    core, kernels = card()
    core.refuses = OUT
    with pytest.raises(MemoryError, match=message):
        kernels.launcher(ENTRY, 32)(1, 4711, 5)


def test_a_card_that_stops(card):
    core, kernels = card()
    core.refuses = ValueError("CUDA_ERROR_LAUNCH_FAILED")
    with pytest.raises(RuntimeError, match=r"card 1 does not run .*\(CUDA_ERROR_LAUNCH_FAILED\)"):
        kernels.launcher(ENTRY, 32)(1, 4711, 5)


def test_without_the_package(monkeypatch):
    plain = builtins.__import__

    def refuse(name, *arguments):
        if name.startswith("cuda"):
            raise ImportError(name)
        return plain(name, *arguments)

    cuda.cuda_core.cache_clear()
    monkeypatch.setattr(builtins, "__import__", refuse)
    with pytest.raises(ImportError, match=r'cuda-core: pip install "arkanoid\[gpu\]"'):
        cuda.CudaKernels([ENTRY], 0)
