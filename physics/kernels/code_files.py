"""Files of machine code: one for each signature of a kernel, with a checksum.

Python's `pickle` and the processor trust what they read: a single flipped bit may end in any
exception, in a crash or in wrong numbers. So the checksum is compared before anything else is read.
"""

import glob
import pickle
import shutil
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any

from .sealed import unseal, write_sealed

_MARK = b"ARKACODE"
_VERSION = 1


class CodeFiles:
    """The files of one kernel.

    A file's name is made from its key, so two processes that compile two signatures at the same
    time never write the same file.

    Args:
        folder: where they lie.
        stem: what their names begin with; no other kernel in the folder has it.
        dump: pickles what Numba hands over; `pickle` alone cannot.
    """

    def __init__(self, folder: Path, stem: str, dump: Callable[[Any], bytes]) -> None:
        self._folder = folder
        self._stem = stem
        self._dump = dump

    def load(self, key: Any) -> Any:
        """Return what was saved for a key, or None. A damaged file is deleted.

        Raises:
            OSError: the file cannot be read, or the damaged one cannot be deleted.
        """
        path = self._path(key)
        try:
            content = unseal("file of machine code", _MARK, _VERSION, path.read_bytes())
        except FileNotFoundError:
            return None
        except ValueError:
            path.unlink(missing_ok=True)
            return None
        except OSError:  # this alone is no damage: too many files may be open
            if not path.is_dir():
                raise
            shutil.rmtree(path)
            return None
        saved_key, data = pickle.loads(content)
        return data if saved_key == key else None

    def save(self, key: Any, data: Any) -> None:
        """Save the data for a key. Other processes see the whole file or none.

        Raises:
            OSError: it cannot be written.
        """
        write_sealed(self._path(key), _MARK, _VERSION, self._dump((key, data)))

    def flush(self) -> None:
        """Delete the files."""
        for path in self._folder.glob(f"{glob.escape(self._stem)}.*.nbc"):
            path.unlink(missing_ok=True)

    def _path(self, key: Any) -> Path:
        name = sha256(repr(key).encode()).hexdigest()[:16]
        return self._folder / f"{self._stem}.{name}.nbc"
