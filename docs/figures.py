"""Draws the pictures in docs/figures from the engine's own answers.

Run it as ``python docs/figures.py [folder]``.
"""

import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import contact_figures
import impact_figures
import world_figures
from drawing import save
from matplotlib.figure import Figure

FOLDER = Path(__file__).resolve().parent / "figures"

FIGURES: dict[str, Callable[[], Figure]] = {
    "colliders": contact_figures.colliders,
    "contacts": contact_figures.contacts,
    "minkowski": contact_figures.minkowski,
    "open": contact_figures.opened,
    "impacts": impact_figures.impacts,
    "disc_disc": impact_figures.disc_disc,
    "disc_convex": impact_figures.disc_convex,
    "axes": impact_figures.axes_in_time,
    "bounce": impact_figures.bounces,
    "relaxation": contact_figures.relaxed,
    "world": world_figures.stepped,
}


def main(arguments: Sequence[str]) -> None:
    """Write every figure into a folder."""
    folder = Path(arguments[0]) if arguments else FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    for name, draw in FIGURES.items():
        save(draw(), folder / f"{name}.svg")


if __name__ == "__main__":
    main(sys.argv[1:])
