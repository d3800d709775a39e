"""What a vector environment tells of each world beside the observations."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..observe.parts import copy_of
from ..state import INFO_FIELDS
from .batch import Batch
from .stepping import tabulate_outcomes


def infos_of(outcomes: Any, mask: NDArray[np.bool_]) -> dict[str, Any]:
    """Return what outcomes tell, and for each key the worlds that have it.

    Args:
        outcomes: `Outcome` records [n].
        mask: bool [n], the worlds that are told of; the others have zeros.
    """
    table = np.empty((len(INFO_FIELDS), len(mask)), np.int64)
    tabulate_outcomes(outcomes, table)
    if not mask.all():
        table *= mask
    owners = mask.copy()
    infos: dict[str, Any] = {}
    for key, values in zip(INFO_FIELDS, table, strict=True):
        infos[key] = values
        infos[f"_{key}"] = owners
    return infos


def final_infos(batch: Batch, done: NDArray[np.bool_]) -> dict[str, Any]:
    """Return the last observations and infos of the episodes that ended in the latest step.

    Args:
        batch: in same-step mode.
        done: bool [n], where one ended.
    """
    if not done.any():
        return {}
    final = np.full(len(done), None, object)
    for index in np.flatnonzero(done):
        final[index] = copy_of(batch.final_observations[index])
    return {
        "final_obs": final,
        "_final_obs": done,
        "final_info": infos_of(batch.finals, done),
        "_final_info": done.copy(),
    }
