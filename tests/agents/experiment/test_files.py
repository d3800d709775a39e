"""Files exist whole or not at all; a failed write keeps the old file and leaves no other."""

import contextlib
import errno
import os
import shlex
import socket
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from arkanoid.agents.experiment.files import quoted
from arkanoid.agents.show.film import Picture, write_film
from arkanoid.envs import atomic
from arkanoid.envs.atomic import remove_unfinished, replace_atomically, write_atomically
from arkanoid.envs.reading import read_limited
from helpers.processes import run_program

FULL = OSError(errno.ENOSPC, "No space left on device")


def test_a_file_is_written_whole(tmp_path: Path) -> None:
    path = tmp_path / "file"
    for content in (b"first", b"second, and longer", b""):
        write_atomically(path, content)
        assert path.read_bytes() == content
        assert list(tmp_path.iterdir()) == [path]


def test_a_file_gets_the_permissions_of_any_new_file(tmp_path: Path) -> None:
    (tmp_path / "any").write_bytes(b"")
    write_atomically(tmp_path / "whole", b"")
    assert (tmp_path / "whole").stat().st_mode == (tmp_path / "any").stat().st_mode


@pytest.mark.parametrize("where", ["write", "fsync", "replace"])
@pytest.mark.parametrize("error", [FULL, KeyboardInterrupt()])
def test_a_failed_write_leaves_the_old_file_and_nothing_else(
    where: str, error: BaseException, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "file"
    write_atomically(path, b"old")

    def fail(*_: object) -> None:
        raise error

    def write(unfinished: Path) -> None:
        unfinished.write_bytes(b"ne")
        if where == "write":
            fail()

    if where != "write":
        monkeypatch.setattr(atomic.os, where, fail)
    with pytest.raises(type(error)):
        replace_atomically(path, write)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_two_writers_of_one_file_do_not_mix(tmp_path: Path) -> None:
    """With one name for all unfinished files, one writer published the other's half."""
    path = tmp_path / "file"
    inside = threading.Barrier(2)

    def write(content: bytes) -> None:
        def halves(unfinished: Path) -> None:
            with unfinished.open("wb") as file:
                file.write(content[:3])
                file.flush()
                inside.wait()
                file.write(content[3:])

        replace_atomically(path, halves)

    writers = [threading.Thread(target=write, args=(content,)) for content in (b"aaaaaa", b"bbbb")]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join()
    assert path.read_bytes() in (b"aaaaaa", b"bbbb")
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_a_link_is_replaced_and_not_followed(tmp_path: Path) -> None:
    """A received run can contain links to the reader's own files."""
    precious = tmp_path / "precious"
    precious.write_bytes(b"mine")
    (tmp_path / "file").symlink_to(precious)
    write_atomically(tmp_path / "file", b"theirs")
    assert precious.read_bytes() == b"mine"


def test_what_a_killed_process_left_is_removed(tmp_path: Path) -> None:
    program = (
        "import os, sys; from pathlib import Path\n"
        "from arkanoid.envs.atomic import replace_atomically\n"
        "replace_atomically(Path(sys.argv[1]), lambda unfinished: os._exit(7))"
    )
    path = tmp_path / "file"
    run_program(program, path, status=7)
    (left,) = tmp_path.iterdir()
    assert left.name.startswith("unfinished-")
    write_atomically(path, b"kept")
    remove_unfinished(tmp_path)
    assert list(tmp_path.iterdir()) == [path]


def test_no_more_is_read_than_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_bytes(b"12345")
    assert read_limited(path, 5) == b"12345"
    with pytest.raises(ValueError, match="larger than 4 bytes"):
        read_limited(path, 4)


@pytest.mark.skipif(sys.platform == "win32", reason="folders and pipes of another kind")
def test_what_is_no_file_is_not_read(tmp_path: Path) -> None:
    """A pipe in the place of a checkpoint kept its reader waiting for ever."""
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, Path("/dev/zero"), Path("/dev/null")):
        with pytest.raises(OSError, match=r"not a regular file|Is a directory"):
            read_limited(path, 5)
    with socket.socket(socket.AF_UNIX) as listening:
        # The path of a socket is short.
        with contextlib.chdir(tmp_path):
            listening.bind("socket")
        with pytest.raises(OSError, match="No such device"):
            read_limited(tmp_path / "socket", 5)


@pytest.mark.skipif(sys.platform == "win32", reason="another shell")
@pytest.mark.parametrize("name", ["plain", "two words", "a'b", "$(touch x)", ";x", "-rf", "é"])
def test_a_printed_path_is_one_word_of_the_shell(name: str) -> None:
    (word,) = shlex.split(quoted(Path(name)))
    assert Path(word) == Path(name)
    assert not word.startswith("-")


def pictures(count: int, then: BaseException | None = None) -> Iterator[Picture]:
    for index in range(count):
        yield np.full((64, 64, 3), index * 7 % 256, np.uint8)
    if then is not None:
        raise then


@pytest.mark.parametrize("name", ["film.gif", "film.mp4"])
@pytest.mark.parametrize("error", [FULL, KeyboardInterrupt()])
def test_a_film_that_fails_leaves_the_old_one(
    name: str, error: BaseException, tmp_path: Path
) -> None:
    path = tmp_path / name
    write_film(path, pictures(5), 20)
    old = path.read_bytes()
    with pytest.raises(type(error)):
        write_film(path, pictures(3, error), 20)
    assert path.read_bytes() == old
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of a file's size there")
@pytest.mark.parametrize("name", ["film.gif", "film.mp4"])
def test_a_film_for_which_there_is_no_space_leaves_the_old_one(name: str, tmp_path: Path) -> None:
    """The exit status of ffmpeg is hidden: once a film without its end passed for a whole one."""
    path = tmp_path / name
    write_film(path, pictures(5), 20)
    old = path.read_bytes()
    program = (
        "import resource, signal, sys; from pathlib import Path\n"
        "import numpy as np; from arkanoid.agents.show.film import write_film\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))\n"
        "noise = np.random.default_rng(0).integers(0, 256, (60, 64, 64, 3), np.uint8)\n"
        "try: write_film(Path(sys.argv[1]), iter(noise), 20)\n"
        "except OSError as error: sys.exit(f'refused: {error}')"
    )
    done = run_program(program, path, status=1)
    assert done.stderr.startswith("refused: ")
    assert path.read_bytes() == old
    assert list(tmp_path.iterdir()) == [path]


def test_a_film_may_have_a_colon_in_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Films are written by ffmpeg, which takes the text before a colon for a protocol."""
    if os.name == "nt":
        return
    monkeypatch.chdir(tmp_path)
    write_film(Path("file:a.mp4"), pictures(3), 20)
    assert [path.name for path in tmp_path.iterdir()] == ["file:a.mp4"]


def test_a_failed_write_names_the_file(tmp_path: Path) -> None:
    """The sentence named `unfinished-1a2b3c4d-model.zip`, of which nobody knows."""
    (tmp_path / "model.zip").mkdir()
    with pytest.raises(OSError, match=r"irectory|denied") as caught:
        write_atomically(tmp_path / "model.zip", b"content")
    assert caught.value.filename == str(tmp_path / "model.zip")
    assert caught.value.filename2 is None
    assert "unfinished" not in str(caught.value)


@pytest.mark.skipif(sys.platform != "linux", reason="other systems count letters, not bytes")
@pytest.mark.parametrize("letter", ["a", "é", "\N{SNOWMAN}"])
def test_a_name_may_be_as_long_as_the_system_takes(letter: str, tmp_path: Path) -> None:
    """The name of the unfinished file was longer: names of 236 letters and more were refused."""
    count, rest = divmod(255 - len(".gif"), len(letter.encode()))
    path = tmp_path / f"{'a' * rest}{letter * count}.gif"
    assert len(path.name.encode()) == 255
    write_film(path, pictures(3), 20)
    assert list(tmp_path.iterdir()) == [path]
