"""Wrong calls of the command, typed into a terminal: each gets a sentence, at once.

The calls run in pseudo-terminals, in a folder with files that are not what they seem to be. None
may show a traceback, take long, or end with another status than 2.
"""

import os
import shutil
import struct
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple
from zipfile import ZipFile

import pytest
from arkanoid.agents.experiment.packed import WEIGHTS
from helpers.processes import ARKANOID
from helpers.runs import packaged_copy

if sys.platform == "win32":
    pytest.skip("there are no pseudo-terminals", allow_module_level=True)

import fcntl
import pty
import termios

# What takes seconds to load; no wrong call may.
SLOW = ("matplotlib", "optuna", "pandas", "stable_baselines3", "tensorboard", "torch")
# Letters of the longest sentences: those that list all levels or settings.
LONGEST = 420
LINUX = sys.platform.startswith("linux")
NO_SCREEN = {"DISPLAY": "", "WAYLAND_DISPLAY": "", "SDL_VIDEODRIVER": ""}

# What is typed after `arkanoid`, and words of the answer. RUN is the folder of a run.
CALLS = {
    # No such command, option or argument
    "trian quick": "did you mean train?",
    "frobnicate": "the commands are play, ",
    "--frobnicate": "unknown option --frobnicate",
    "levels --pgn x.png": "did you mean --png?",
    "watch --levle spiral": "did you mean --level?",
    "evaluate --jsn": "did you mean --json?",
    "replay": "FILE is missing",
    "report": "RUN is missing",
    "film": "OUT is missing",
    "dataset a/b-v0": "PLAYER is missing",
    "reproduce RUN RUN": "one argument too many",
    "levels --png": "--png",
    "train --seed": "--seed needs a value",
    "train quick --resume RUN": "give no others",
    "reproduce RUN --seed 1": "its own settings",
    "evaluate RUN RUN": "given twice",
    "train quick --track tensorboard": "'mlflow'",
    # Options and settings that would change nothing there
    "evaluate RUN --ppo.gamma 0.9": "--ppo.gamma changes nothing here",
    "evaluate RUN --validation.episodes 3": "did you mean --evaluation.episodes?",
    "evaluate RUN --evaluation.film_seconds 3": "changes nothing here",
    "watch RUN --seed 5": "did you mean --evaluation.seed?",
    "film RUN x.gif --imitation.epochs 3": "changes nothing here",
    "report RUN --training.timesteps 5": "changes nothing here",
    "dataset a/b-v0 RUN --ppo.gamma 1": "changes nothing here",
    "dataset a/b-v0 a.replay --games 3": "games that were played",
    "web --out x.html --port 8000": "nothing is served",
    "web --ppo.gamma 1": "unknown option --ppo.gamma",
    "web --port 99999": "at most 65535",
    "web --model nothing": "the folder of a run",
    "watch --port 8000": "add --web",
    "watch --web --evaluation.seed 3": "changes nothing here",
    "watch --web --port 99999": "at most 65535",
    "film RUN x.gif --level named": "a film shows one",
    "film RUN x.gif --out y.gif": "two films are named",
    "film --out": "--out",
    "replay mine.txt --from 3": "--export",
    "replay mine.txt --verify --height 64": "--verify",
    "levels spiral --difficulty 0.3": "of generated levels",
    # Lists, empty texts, and names that are none
    "evaluate RUN --evaluation.baselines planner": """typed as '["planner"]'""",
    "train --network.hidden 64": "typed as '[64]'",
    "film RUN x.gif --level=": "an empty text is given for level",
    "levels seeds:9-3": "got 'seeds:9-3'",
    "dataset a/b-v0 nobody": "neither a baseline",
    # Settings
    "train --ppo.gama 0.9": "'ppo.gamma'",
    "train --seed -1": "at least 0",
    "train --seed 1.5": "an integer",
    "train --training.timesteps 1e6x": "an integer",
    "train --training.worlds 1e9": "at most 1000000",
    "train --ppo.learning_rate fast": "a number, above 0",
    "train --ppo.batch_size 1000": "must divide",
    "train --evaluation.suites games": "a list of texts",
    "evaluate RUN --evaluation.suites ['all']": "'named'",
    "train --env.livs 3": "did you mean 'lives'?",
    "train --env.lives 0": "lives must be between",
    "train --env_id CartPole-v1": "CartPole-v1",
    "train --name a/b": "'name'",
    "train --output /dev/null/runs": "is no folder",
    # Numbers
    "tune quick --trials 0": "at least 1",
    "tune quick --budget soon": "above 0",
    "tune quick --validation.every 9": "--budget",
    "film RUN x.gif --seconds 0": "above 0",
    "replay mine.txt --speed 0": "from 0.001 to 1000",
    "levels seed:1 --difficulty 2": "from 0 to 1",
    "dataset a/b-v0 planner --games none": "at least 1",
    # Files that are not there, or are something else
    "train nothing.toml": "the name of a packaged one",
    "train RUN/model.zip": "not a TOML file",
    "train mine.txt": "not a TOML file",
    "train --resume nothing": "the folder of a run",
    "train --from nothing": "the folder of a run",
    "reproduce .": "the folder of a run",
    "tune quick --space nothing": "wide",
    "evaluate nothing": "the folder of a run",
    "evaluate RUN/config.toml": "no model",
    "evaluate RUN/notes.txt": "give the folder of its run",
    "evaluate cut": "damaged",
    "evaluate others.zip": "config.toml",
    "watch mine.txt": "no model",
    "watch nothing --web": "the folder of a run",
    "replay nothing.replay": "No such file",
    "replay mine.txt": "no replay",
    # Another game than the model's
    "evaluate RUN --env.observation rgb": "leave out --env.observation",
    "film RUN x.gif --env_id Arkanoid-v0": "'env.actions'",
    "film RUN x.gif --level warden": "choose another level",
    # Levels
    "levels spirol": "Did you mean 'spiral'?",
    "levels wrong.txt": "line 3, column 3",
    "levels seed:x": "seed:7",
    "levels seeds:0-999": "at most 100",
    "film RUN x.gif --level nowhere": "seeds:0-9",
    "train --env.levels nowhere": "no level 'nowhere'",
    # Files that cannot be written
    "levels --png x.jpg": "end in .png",
    "levels --png nowhere/x.png": "no such folder",
    "film RUN x.jpg": ".gif or .mp4",
    "film RUN nowhere/x.gif": "no such folder",
    "web --out x.htm": "end in .html",
    "web --out nowhere/x.html": "no such folder",
    "report RUN --out x.pdf": ".html or .md",
    "evaluate RUN --plots /dev/null/x": "is no folder",
    "replay mine.txt --export x.avi": ".png",
    "tune quick --out nowhere/x.toml": "no such folder",
}
# Without a screen; elsewhere there is always one.
BLIND = {
    "play": "arkanoid film game.gif",
    "play --lite --level mine.txt": "--level mine.txt",
    "watch RUN": "arkanoid film RUN game.gif",
    "watch RUN --level seed:3": "film RUN game.gif --level seed:3",
    "play --level spirol": "Did you mean 'spiral'?",
    "play --lives 0": "lives must be between",
    "watch --level spirol": "Did you mean 'spiral'?",
    "watch": "no display",
    "watch lite": "arkanoid watch lite --web --no-open",
}


class Answer(NamedTuple):
    """What a terminal shows in the end, and the exit status."""

    text: str
    status: int


def typed(call: str, folder: Path, before: Sequence[str] = (), **variables: str) -> Answer:
    """Type a call into a terminal of 80 columns, and wait for its end.

    ``before`` is a program that does something first, and then becomes the call.
    """
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    environment = {**os.environ, "PYTHONIOENCODING": "utf-8", **NO_SCREEN, **variables}
    process = subprocess.Popen(
        [*before, *ARKANOID, *call.split()],
        cwd=folder,
        env=environment,
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
    )
    os.close(theirs)
    shown = b""
    try:
        while part := os.read(ours, 4096):
            shown += part
    except OSError:  # so a terminal tells that nobody writes any more
        pass
    process.wait()
    os.close(ours)
    text = shown.decode("utf-8", "replace").replace("\r\n", "\n")
    return Answer(text, process.returncode)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a run, and with files that are not what a call takes them for."""
    folder = tmp_path_factory.mktemp("calls")
    run = folder / "RUN"
    packaged_copy(run)
    (run / "notes.txt").write_text("Monday: trained.\n")
    cut = folder / "cut"
    cut.mkdir()
    shutil.copy(run / "config.toml", cut)
    (cut / "model.zip").write_bytes((run / "model.zip").read_bytes()[:3000])
    with ZipFile(run / "model.zip") as ours, ZipFile(folder / "others.zip", "w") as others:
        others.writestr(WEIGHTS, ours.read(WEIGHTS))
    (folder / "mine.txt").write_text("name: Mine\n\n.rrrrrrrrr.\n")
    (folder / "wrong.txt").write_text("name: Wrong\n\n.rkrrrrrrr.\n")
    # Afterwards, a call that compiles says so, which is no answer.
    typed("levels --png x.png spiral", folder)
    return folder


@pytest.fixture(scope="module")
def fakes(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A folder in which what is slow to import fails."""
    folder = tmp_path_factory.mktemp("fakes")
    for name in SLOW:
        (folder / f"{name}.py").write_text("raise AssertionError(__name__)\n")
    return str(folder)


def check(answer: Answer, words: str) -> None:
    """Check that an answer is a sentence with these words."""
    assert "Traceback" not in answer.text
    assert answer.status == 2, answer.text
    assert answer.text.startswith("arkanoid: error: ")
    assert answer.text.count("\n") == 1, answer.text
    assert words in answer.text
    assert len(answer.text) < LONGEST


def test_there_are_sixty() -> None:
    assert len(CALLS) + len(BLIND) >= 60


@pytest.mark.parametrize("call", CALLS)
def test_a_wrong_call_gets_a_sentence(call: str, folder: Path, fakes: str) -> None:
    check(typed(call, folder, PYTHONPATH=fakes), CALLS[call])


@pytest.mark.skipif(not LINUX, reason="there is always a display")
@pytest.mark.parametrize("call", BLIND)
def test_without_a_display_it_says_what_works(call: str, folder: Path, fakes: str) -> None:
    """A window opened that nobody could see, and the game went on for ever."""
    check(typed(call, folder, PYTHONPATH=fakes), BLIND[call])


@pytest.mark.skipif(not LINUX, reason="there is always a display")
def test_a_display_that_does_not_answer_is_none(folder: Path) -> None:
    """SDL then takes a driver that shows nothing."""
    check(typed("play", folder, DISPLAY=":4711"), "no display")


@pytest.mark.skipif(not LINUX, reason="folders in use cannot be deleted elsewhere")
@pytest.mark.parametrize("call", ["levels", "evaluate"])
def test_a_folder_that_was_deleted_is_named(call: str, tmp_path: Path) -> None:
    """Torch ended the whole process, with an error of its library for linear algebra."""
    gone = tmp_path / "gone"
    gone.mkdir()
    program = "import os, sys; os.rmdir(os.getcwd()); os.execv(sys.argv[1], sys.argv[1:])"
    answer = typed(call, gone, before=[sys.executable, "-c", program])
    check(answer, "go to another one")


def test_a_missing_extra_is_named(folder: Path, tmp_path: Path) -> None:
    missing = "raise ModuleNotFoundError('No module named pydantic', name='pydantic')"
    (tmp_path / "pydantic.py").write_text(missing)
    answer = typed("evaluate RUN", folder, PYTHONPATH=str(tmp_path))
    assert answer.status == 1
    assert 'install -e ".[train]"' in answer.text
    assert answer.text.count("\n") == 1


@pytest.mark.skipif(getattr(os, "geteuid", lambda: 0)() == 0, reason="root may write anywhere")
def test_a_folder_that_may_not_be_written_into_is_named(folder: Path) -> None:
    locked = folder / "locked"
    locked.mkdir(mode=0o500)
    for call in ("film RUN locked/x.gif", "train --output locked", "levels --png locked/x.png"):
        check(typed(call, folder), "may not write")


@pytest.mark.parametrize("call", ["", "--help", "levels --help"])
def test_help_is_no_mistake(call: str, folder: Path) -> None:
    answer = typed(call, folder)
    assert answer.status == 0
    assert answer.text.startswith("usage: arkanoid")
    assert max(map(len, answer.text.splitlines())) < 80
