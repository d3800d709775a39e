"""What commands print, wherever it goes, and what they need to print their help."""

import os
import sys
from pathlib import Path

import pytest
from arkanoid.agents.cli import _EXTRAS, COMMANDS
from arkanoid.agents.experiment.runs import RunFolder
from helpers.processes import ARKANOID, run, run_program
from helpers.runs import SMALL

WITHOUT_EXTRAS = f"""
import sys
for package in {sorted(_EXTRAS)}:
    sys.modules[package] = None
from arkanoid.agents.cli import main
sys.exit(main(sys.argv[1:]))
"""
PRINTING = {
    "help": ["--help"],
    "help of a command": ["levels", "--help"],
    "version": ["--version"],
    "list": ["levels"],
    "level": ["levels", "spiral"],
    "JSON": [
        *("evaluate", "--json", "--evaluation.suites", '["games"]', "--evaluation.episodes", "1"),
        *("--evaluation.baselines", "[]", "--env.max_decisions", "20"),
    ],
}


@pytest.mark.parametrize("command", COMMANDS)
def test_help_needs_no_extra(command: str) -> None:
    """`arkanoid train --help` said that torch was missing to somebody who asks what it does."""
    out = run_program(WITHOUT_EXTRAS, command, "--help").stdout
    assert COMMANDS[command] in out
    assert "options:" in out


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="there is no /dev/full")
@pytest.mark.parametrize("command", PRINTING.values(), ids=PRINTING)
def test_a_full_disk_behind_the_output_is_named(command: list[str]) -> None:
    """One command had a traceback, one said "error: None", and the help ended as if all was well.

    What is buffered is only written at the end, where Python hid the error.
    """
    done = run("sh", "-c", '"$@" > /dev/full', "sh", *ARKANOID, *command, status=2)
    *_, last = done.stderr.splitlines()
    assert last == "arkanoid: error: the output cannot be written: No space left on device"
    assert "Traceback" not in done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="another shell")
@pytest.mark.parametrize("command", PRINTING.values(), ids=PRINTING)
def test_a_reader_that_has_ended_is_no_error(command: list[str]) -> None:
    script = '{ "$@"; echo "status $?" >&2; } | true'
    done = run("sh", "-c", script, "sh", *ARKANOID, *command)
    *messages, status = done.stderr.splitlines()
    assert status == "status 1"
    assert not any("rror" in message for message in messages)


@pytest.mark.skipif(sys.platform == "win32", reason="another shell")
def test_without_an_output_a_command_runs() -> None:
    run("sh", "-c", '"$@" >&-', "sh", *ARKANOID, *PRINTING["list"])


# Notes


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="there is no /dev/full")
@pytest.mark.parametrize("notes", ["2>/dev/full", "2>&-"])
def test_nobody_needs_to_read_the_notes(notes: str, tmp_path: Path) -> None:
    """A training died of its progress bar, and a measurement of its first note."""
    output = tmp_path / "runs"
    settings = {**SMALL, "output": str(output)}
    words = ["train", "quick", *(f"--{key}={value}" for key, value in settings.items())]
    for command in (words, PRINTING["JSON"]):
        done = run("sh", "-c", f'"$@" {notes}', "sh", *ARKANOID, *command)
        assert done.stdout
    (path,) = output.iterdir()
    assert RunFolder(path).read_notes()["outcome"] == "finished"


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="there is no /dev/full")
@pytest.mark.parametrize("notes", ["2>/dev/full", "2>&-", "2>&- >&- <&-"])
@pytest.mark.parametrize(
    ("command", "status"),
    [(["levels"], 0), (["levels", "no_such"], 2), (["no_such"], 2), (["train", "--x"], 2)],
    ids=str,
)
def test_the_status_tells_without_the_notes(command: list[str], status: int, notes: str) -> None:
    """Python gave 120 instead, because it could not write the rest at its end."""
    run("sh", "-c", f'"$@" {notes}', "sh", *ARKANOID, *command, status=status)


def test_notes_of_libraries_do_not_get_into_other_files(tmp_path: Path) -> None:
    """A file that is opened when standard error is closed gets its number."""
    program = (
        "import os, sys; from arkanoid.agents.output import harmless_notes\n"
        "os.close(2); sys.stderr = None\n"
        "with harmless_notes(sys.stderr), open(sys.argv[1], 'wb', 0) as file:\n"
        "    print('note', file=sys.stderr)\n"
        "    os.write(2, b'note of a library')\n"
        "    file.write(b'content')"
    )
    run_program(program, tmp_path / "file")
    assert (tmp_path / "file").read_bytes() == b"content"


# Ctrl-C

INTERRUPTED_MODULE = """
import os, signal
try:
    signal.raise_signal(signal.SIGINT)
except KeyboardInterrupt:
    raise ImportError("as compiled modules do") from None
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Ctrl-C is no signal there")
@pytest.mark.parametrize("module", ["gymnasium", "pydantic"])
def test_ctrl_c_is_told_while_modules_are_imported(module: str, tmp_path: Path) -> None:
    """It was a traceback, or an ImportError of the module that was being imported."""
    (tmp_path / f"{module}.py").write_text(INTERRUPTED_MODULE)
    changes = {"PYTHONPATH": os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])}
    script = Path(sys.executable).with_name("arkanoid")
    for command in [ARKANOID, *([(str(script),)] if script.exists() else [])]:
        done = run(*command, "evaluate", changes=changes, status=130)
        assert done.stderr == "arkanoid: error: interrupted\n"


def test_programs_that_import_the_package_keep_their_ctrl_c() -> None:
    run_program(
        "import signal, arkanoid, arkanoid.agents.cli\n"
        "assert signal.getsignal(signal.SIGINT) is signal.default_int_handler"
    )
