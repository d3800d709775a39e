"""What all tests share: the repository's root is the package, not a folder of tests."""

import contextlib
import io
import signal
from pathlib import Path

import pytest

try:
    from hypothesis import settings
except ImportError:  # the environments of `make compat` have the tests that need none
    settings = None

ROOT = Path(__file__).resolve().parent.parent


class RootIsNotATestPackage:
    """Keeps pytest from importing the package a second time.

    The root holds an ``__init__.py``, and pytest takes it for a package of tests: it imports it
    under the name of the folder (whatever a clone is called), with a second copy of every module
    below. Such a copy must be harmless, but no test should run beside one.
    """

    @pytest.hookimpl(tryfirst=True)
    def pytest_collect_directory(
        self, path: Path, parent: pytest.Collector
    ) -> pytest.Collector | None:
        return pytest.Dir.from_parent(parent, path=path) if path == ROOT else None


def pytest_configure(config: pytest.Config) -> None:
    # On a busy machine a correct test may take long.
    if settings is not None:
        settings.register_profile("no deadline", deadline=None)
        settings.load_profile("no deadline")
    # A shell's jobs in the background ignore Ctrl-C, which some tests press.
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    # Not a plain hook: those of a conftest are asked about what lies below its own folder only.
    config.pluginmanager.register(RootIsNotATestPackage())


@pytest.hookimpl(trylast=True)
def pytest_sessionstart() -> None:
    """Say what is compiled before the tests: the first one for a kernel would get the lines."""
    from arkanoid.physics.kernels import messages

    with contextlib.redirect_stderr(io.StringIO()):
        for module in messages.PARTS:
            messages.say_compiling(module)


@pytest.fixture
def dummy_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    """SDL's screen without a display: Gymnasium's checker opens a window, too."""
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
