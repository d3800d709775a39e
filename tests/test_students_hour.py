"""A student's first hour: a clone, a training, a changed setting, a film, a level of one's own.

Everything is typed into a shell that has activated nothing. What the program says to type is typed
as it was printed. Only the budgets are tiny.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from helpers.processes import ARKANOID, PATIENCE, wait_for
from helpers.repository import ROOT
from helpers.runs import SMALL

if sys.platform == "win32":
    pytest.skip("another shell", allow_module_level=True)

TINY = " ".join(f"--{key} '{value}'" for key, value in SMALL.items())
SCRIPT = Path(sys.executable).with_name("arkanoid")
START = str(SCRIPT) if SCRIPT.exists() else " ".join(ARKANOID)


class Student:
    """Somebody at a shell in a folder, who knows no more than was printed."""

    def __init__(self, folder: Path, environment: dict[str, str]) -> None:
        self.folder = folder
        self.environment = environment
        self.said = ""

    def types(self, command: str, status: int = 0) -> str:
        """Type a command; return what it says."""
        done = subprocess.run(
            ["sh", "-c", command],
            cwd=self.folder,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            timeout=PATIENCE,
        )
        assert done.returncode == status, f"{command}\n{done.stdout}\n{done.stderr}"
        self.said = done.stdout + done.stderr
        return self.said

    def stops(self, command: str, when: Callable[[], bool]) -> str:
        """Type a command and press Ctrl-C when it has come so far; return what it says."""
        running = subprocess.Popen(
            f"exec {command}",
            shell=True,
            cwd=self.folder,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
        )
        wait_for(when, running)
        running.send_signal(signal.SIGINT)
        self.said, _ = running.communicate(timeout=PATIENCE)
        assert running.returncode == 130, self.said
        return self.said

    def reads(self, label: str) -> str:
        """Return what stands behind a label in what was said last."""
        (found,) = re.findall(rf"^{label} +(.+)$", self.said, re.MULTILINE)
        return found


@pytest.fixture
def student(tmp_path: Path) -> Student:
    # No virtual environment is on the PATH, and there is no display.
    hidden = ("PATH", "VIRTUAL_ENV", "DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
    environment = {key: value for key, value in os.environ.items() if key not in hidden}
    return Student(tmp_path, environment | {"PATH": os.defpath, "PYTHONIOENCODING": "utf-8"})


def test_an_hour(student: Student) -> None:
    here = student.folder
    # The clone has the configs and the documentation; what runs is the package under test.
    if (ROOT / ".git").exists() and shutil.which("git", path=student.environment["PATH"]):
        student.types(f"git clone -q '{ROOT}' arkanoid")
        shutil.copy(here / "arkanoid" / "configs" / "quick.toml", here / "quick.toml")
    else:
        shutil.copy(ROOT / "configs" / "quick.toml", here)

    # Train, and type what is printed.
    student.types(f"{START} train quick {TINY}")
    run, curves = student.reads("again").split()[-1], student.reads("curves")
    assert (here / student.reads("film")).is_file()
    assert "ball-follower" in student.types(
        f"{student.reads('again')} --evaluation.baselines '[\"ball-follower\"]'"
    )
    # It would serve them for ever.
    student.types(curves.replace(" --logdir", " --version_tb --logdir"))

    # Change a setting in a file of one's own.
    config = here / "quick.toml"
    text = config.read_text(encoding="utf-8")
    assert "learning_rate = 2e-3" in text
    config.write_text(text.replace("learning_rate = 2e-3", "learning_rate = 1e-3"), "utf-8")
    student.types(f"{START} train quick.toml {TINY} --seed 1 --name mine")
    other = student.reads("again").split()[-1]
    assert other.startswith("runs/mine-seed1")

    # Stop, and resume as it says.
    more = "--training.timesteps 1e6 --ppo.n_epochs 1 --name longer"
    checkpoints = "runs/longer-*/checkpoint.pt"
    student.stops(f"{START} train quick {TINY} {more}", lambda: any(here.glob(checkpoints)))
    resume = student.reads("resume")
    longer = next(here.glob("runs/longer-*"))
    before = (longer / "checkpoint.pt").read_bytes()
    student.stops(resume, lambda: (longer / "checkpoint.pt").read_bytes() != before)
    assert student.reads("resume") == resume

    # Compare both agents, and film one.
    said = student.types(f"{START} evaluate {run} {other}")
    assert "quick " in said
    assert "mine " in said
    # Nothing opens here; but what it says instead does its work.
    said = student.types(f"{START} watch {run}", status=2)
    film, _, browser = said.partition("a film needs none: ")[2].partition("; nor does a browser: ")
    student.types(f"{film} --seconds 0.2")
    assert browser.strip().endswith(f"watch {run} --web --no-open")
    student.types(f"{START} web --model {run} --out game.html")
    assert (here / "game.html").is_file()
    assert (here / "game.gif").is_file()

    # A model by itself.
    shutil.copy(here / run / "model.zip", here / "mine.zip")
    student.types(f"{START} film mine.zip mine.gif --seconds 0.2")

    # A level of one's own.
    level = here / "level.txt"
    student.types(f"{START} levels spiral > level.txt")
    level.write_text(level.read_text("utf-8").replace("Spiral", "Mine").replace("r", "y"), "utf-8")
    student.types(f"{START} levels level.txt --png level.png")
    assert (here / "level.png").is_file()
    student.types(f"{START} evaluate {run} --env.levels level.txt")
    said = student.types(f"{START} play --level level.txt", status=2)
    student.types(f"{said.partition('needs none: ')[2].strip()} --seconds 0.2")
