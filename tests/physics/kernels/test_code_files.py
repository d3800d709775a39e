"""Files of machine code: what was saved is loaded, and nothing else is."""

import errno
import pickle
from pathlib import Path

import pytest
from arkanoid.physics.kernels.code_files import CodeFiles

KEY = ("float64", "processor", "bytecode")
DATA = {"code": b"\x7fELF" + bytes(range(64))}


@pytest.fixture
def files(tmp_path: Path) -> CodeFiles:
    """Return the files of one kernel, with one of them saved."""
    result = CodeFiles(tmp_path, "kernel", pickle.dumps)
    result.save(KEY, DATA)
    return result


def test_each_key_has_its_own_data(files: CodeFiles) -> None:
    files.save("other", 5)
    files.save("other", 6)
    assert (files.load(KEY), files.load("other"), files.load("third")) == (DATA, 6, None)


def test_every_flipped_bit_is_noticed(files: CodeFiles, tmp_path: Path) -> None:
    (path,) = tmp_path.iterdir()
    content = path.read_bytes()
    for bit in range(8 * len(content)):
        damaged = bytearray(content)
        damaged[bit // 8] ^= 1 << bit % 8
        path.write_bytes(damaged)
        assert files.load(KEY) is None
        assert not path.exists()


def test_every_shorter_file_is_noticed(files: CodeFiles, tmp_path: Path) -> None:
    (path,) = tmp_path.iterdir()
    content = path.read_bytes()
    for size in range(len(content)):
        path.write_bytes(content[:size])
        assert files.load(KEY) is None
        assert not path.exists()


def test_a_file_under_another_name_is_not_loaded(files: CodeFiles, tmp_path: Path) -> None:
    """A checksum does not say what a file is for: the key in it does."""
    (path,) = tmp_path.iterdir()
    content = path.read_bytes()
    files.save("other", 5)
    for each in tmp_path.iterdir():
        each.write_bytes(content)
    assert (files.load(KEY), files.load("other")) == (DATA, None)


def test_a_file_that_cannot_be_read_now_is_kept(
    files: CodeFiles, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(path: Path) -> bytes:
        raise OSError(errno.EMFILE, "too many open files", str(path))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "read_bytes", refuse)
        with pytest.raises(OSError, match="too many open files"):
            files.load(KEY)
    assert files.load(KEY) == DATA


def test_a_failed_save_leaves_nothing(files: CodeFiles, tmp_path: Path) -> None:
    (path,) = tmp_path.iterdir()
    path.unlink()
    path.mkdir()
    with pytest.raises((IsADirectoryError, PermissionError)):
        files.save(KEY, DATA)
    assert list(tmp_path.iterdir()) == [path]


def test_flush_deletes_the_files_of_one_kernel(files: CodeFiles, tmp_path: Path) -> None:
    other = CodeFiles(tmp_path, "kernel2", pickle.dumps)
    other.save(KEY, 7)
    files.flush()
    assert (files.load(KEY), other.load(KEY)) == (None, 7)
