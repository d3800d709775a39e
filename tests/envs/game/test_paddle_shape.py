"""The kernel that fits the paddle's shapes gives the bits of shapes that are built of vertices."""

import numpy as np
import pytest
from arkanoid.envs.config import Config
from arkanoid.envs.game.rulebook import make_rules
from arkanoid.envs.game.shapes import fit_paddle, paddle_collider
from arkanoid.envs.levels.plan import plan_levels
from arkanoid.envs.rules import FIELD_WIDTH, LONG_PADDLE_WIDTH, PADDLE_WIDTH
from arkanoid.physics.shapes.table import shape_table


def factors() -> list[float]:
    luck = np.random.default_rng(1)
    return [0.25, 0.3, 0.5, 1.0, 1.1, 1.5, 2.0, 11 / 3, 4.0, 5.0, *luck.uniform(0.25, 5.0, 2000)]


def test_shapes_of_all_widths() -> None:
    rules = make_rules(Config(), plan_levels(Config()))
    for factor in factors():
        fit_paddle(rules[0], float(factor))
        widths = PADDLE_WIDTH * factor, min(LONG_PADDLE_WIDTH * factor, FIELD_WIDTH)
        shapes, edges = shape_table(map(paddle_collider, widths))
        assert rules["shapes"][0, :2].tobytes() == shapes.tobytes(), factor
        assert rules["edges"][0, : len(edges)].tobytes() == edges.tobytes(), factor
        halves = rules["paddle_half"][0], rules["long_paddle_half"][0]
        assert halves == tuple(width / 2 for width in widths)


@pytest.mark.parametrize("factor", [0.25, 1.7, 5.0])
def test_other_shapes_stay(factor: float) -> None:
    config = Config()
    plain, other = (
        make_rules(each, plan_levels(config)) for each in (config, Config(paddle=factor))
    )
    assert plain["shapes"][0, 2:].tobytes() == other["shapes"][0, 2:].tobytes()
