"""Observations as Gymnasium has them: of records, dictionaries."""

from typing import Any


def parts_of(observations: Any) -> Any:
    """Return observations as Gymnasium has them: an array, or a dictionary of a record's fields."""
    names = observations.dtype.names
    return observations if names is None else {name: observations[name] for name in names}


def copy_of(observations: Any) -> Any:
    """Return observations as `parts_of`, in memory of their own."""
    names = observations.dtype.names
    if names is None:
        return observations.copy()
    return {name: observations[name].copy() for name in names}
