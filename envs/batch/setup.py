"""What has to be the same where a state is taken and where it is restored."""

import hashlib
import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..config import Config
from ..levels.plan import LevelPlan
from ..rules import RULES_VERSION
from ..state import Outcome, World


def describe_setup(
    config: Config, plan: LevelPlan, rules: NDArray[Any], observations: "np.dtype[Any]"
) -> bytes:
    """Return, as JSON, what a state is bound to: rules, configuration, levels and layout.

    Levels count by their contents, because a file may change and keep its name.
    """
    keywords = config.plain()
    del keywords["levels"]
    keywords["size"] = config.picture_size
    levels = (plan.table.tobytes(), plan.seeds, plan.endless, len(plan.names))
    layout = (World.descr, Outcome.descr, rules.tobytes(), observations.str)
    setup = {
        "rules": RULES_VERSION,
        "config": keywords,
        "levels": hashlib.sha256(repr(levels).encode()).hexdigest()[:16],
        "layout": hashlib.sha256(repr(layout).encode()).hexdigest()[:16],
    }
    return json.dumps(setup).encode()
