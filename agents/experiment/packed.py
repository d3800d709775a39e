"""A model's file: stable-baselines3's zip file, with the settings of its run in it."""

import zipfile
from pathlib import Path

WEIGHTS = "policy.pth"  # stable-baselines3's name for the weights
SETTINGS = "config.toml"  # ours, which it does not read
_LARGEST_SETTINGS = 2**20  # bytes


def has_weights(path: Path) -> bool:
    """Tell whether there are weights in a file; raises ValueError if it is no zip file."""
    return WEIGHTS in _names(path)


def holds_settings(path: Path) -> bool:
    """Tell whether a model's file has the settings of its run."""
    return SETTINGS in _names(path)


def read_packed(path: Path) -> str:
    """Return the settings in a model's file, as TOML.

    Raises ValueError if they are too large or damaged.
    """
    try:
        with zipfile.ZipFile(path) as archive, archive.open(SETTINGS) as file:
            content = file.read(_LARGEST_SETTINGS + 1)
    except (OSError, zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError) as error:
        raise ValueError(str(error)) from None
    if len(content) > _LARGEST_SETTINGS:
        raise ValueError(f"more than {_LARGEST_SETTINGS:,} bytes")
    return content.decode("utf-8")


def _names(path: Path) -> list[str]:
    """Return the names in a zip file; ValueError: it is none."""
    try:
        with zipfile.ZipFile(path) as archive:
            return archive.namelist()
    except zipfile.BadZipFile as error:
        raise ValueError(str(error)) from None
