"""Signals wait until what must not be broken off is done; then their handlers run."""

import signal
import threading
from pathlib import Path

import pytest
from arkanoid.physics.kernels import kernel
from arkanoid.physics.kernels.held_signals import held_signals
from arkanoid.physics.kernels.numba_internals import is_interpreted
from numba.core import event


def test_ctrl_c_comes_at_the_end() -> None:
    before = signal.getsignal(signal.SIGINT)
    steps: list[str] = []

    def interrupt() -> None:
        with held_signals():
            signal.raise_signal(signal.SIGINT)
            steps.append("inside")

    with pytest.raises(KeyboardInterrupt):
        interrupt()
    assert steps == ["inside"]
    assert signal.getsignal(signal.SIGINT) is before
    with held_signals():
        pass


def test_every_signal_with_a_handler_is_held() -> None:
    """Not Ctrl-C alone: a handler of SIGTERM or of a timer may raise, too."""
    came: list[int] = []
    previous = signal.signal(signal.SIGTERM, lambda number, frame: came.append(number))
    try:
        with held_signals():
            signal.raise_signal(signal.SIGTERM)
            assert came == []
        assert came == [signal.SIGTERM]
    finally:
        signal.signal(signal.SIGTERM, previous)


def test_it_comes_at_the_end_of_an_inner_part() -> None:
    """A long compilation consists of short ones."""
    before = signal.getsignal(signal.SIGINT)
    steps: list[str] = []

    def interrupt() -> None:
        with held_signals():
            with held_signals():
                signal.raise_signal(signal.SIGINT)
                steps.append("inner")
            steps.append("outer")

    with pytest.raises(KeyboardInterrupt):
        interrupt()
    assert steps == ["inner"]
    assert signal.getsignal(signal.SIGINT) is before


def test_an_error_inside_is_raised_and_all_is_restored() -> None:
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(ValueError, match="inside"), held_signals():
        raise ValueError("inside")
    assert signal.getsignal(signal.SIGINT) is before


def test_other_threads_hold_nothing() -> None:
    seen = []

    def hold() -> None:
        with held_signals():
            seen.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=hold)
    thread.start()
    thread.join()
    assert seen == [signal.getsignal(signal.SIGINT)]


class Interrupter(event.Listener):  # type: ignore[misc]
    """Presses Ctrl-C in the middle of a compilation."""

    def on_start(self, event: object) -> None:
        signal.raise_signal(signal.SIGINT)

    def on_end(self, event: object) -> None:
        pass


@pytest.mark.skipif(is_interpreted(), reason="nothing is compiled")
def test_ctrl_c_waits_for_the_compiler(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """LLVM's lock stayed locked where it came at a bad moment, and other threads hung."""
    # Otherwise an earlier run has left the compiled kernel.
    monkeypatch.setenv("ARKANOID_CACHE_DIR", str(tmp_path))

    @kernel
    def double(x: float) -> float:
        return x + x

    with event.install_listener("numba:compile", Interrupter()), pytest.raises(KeyboardInterrupt):
        double(2.0)
    assert len(double.signatures) == 1  # type: ignore[attr-defined]
    assert double(2.0) == 4.0
