"""What commands print, wherever it goes, and what they need to print their help."""

import json
import sys
from pathlib import Path

import pytest
from arkanoid.agents.cli import _EXTRAS, COMMANDS
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


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="there is no /dev/full")
@pytest.mark.parametrize("where", ["/dev/full", "&-"])
def test_notes_that_nobody_can_write_stop_no_run(where: str, tmp_path: Path) -> None:
    """A full standard error ended a measurement with status 2, and a closed one spoilt the JSON."""
    command = [*ARKANOID, *PRINTING["JSON"], "--plots", str(tmp_path)]
    done = run("sh", "-c", f'"$@" 2>{where}', "sh", *command)
    assert set(json.loads(done.stdout)) >= {"suites", "models"}
    assert list(tmp_path.glob("*.*"))


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="there is no /dev/full")
def test_a_training_goes_on_where_its_bar_cannot_be_written(tmp_path: Path) -> None:
    settings = [f"--{key}={value}" for key, value in {**SMALL, "output": str(tmp_path)}.items()]
    run("sh", "-c", '"$@" 2>/dev/full', "sh", *ARKANOID, "train", "quick", *settings)
    assert list(tmp_path.rglob("model.zip"))


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="there is no /dev/full")
def test_a_mistake_has_its_status_where_it_cannot_be_told() -> None:
    run("sh", "-c", '"$@" 2>/dev/full', "sh", *ARKANOID, "levels", "nowhere", status=2)
    run("sh", "-c", '"$@" 2>/dev/full', "sh", *ARKANOID, "levels", "--nothing", status=2)


@pytest.mark.skipif(sys.platform == "win32", reason="another shell")
def test_without_an_output_a_command_runs() -> None:
    run("sh", "-c", '"$@" >&-', "sh", *ARKANOID, *PRINTING["list"])
