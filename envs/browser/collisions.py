"""What the manifest says of meetings: two bodies, and all that the engine says of them."""

from base64 import b64encode
from typing import Any

from ...physics.pairs import table
from ...physics.scenes.patterns import POLYGONS, TURNS, make_patterns, make_turns
from ...physics.shapes.table import shape_table
from .image import Memory

_ALGORITHMS = (
    *("DISC_DISC", "DISC_HALF_PLANE", "DISC_BOX", "DISC_CONVEX"),
    *("BOX_BOX", "CONVEX_CONVEX"),
)


def describe_meetings() -> dict[str, Any]:
    """Return the tables that meetings read, as an image of memory, and what their rows are."""
    patterns = make_patterns()
    shapes, edges = shape_table(patterns.values())
    memory = Memory()
    addresses = {
        "patterns": memory.put(shapes),
        "pattern_edges": memory.put(edges),
        "turns": memory.put(make_turns()),
    }
    names = {getattr(table, name): name for name in _ALGORITHMS}
    return {
        "image": b64encode(bytes(memory.content)).decode(),
        "length": len(memory.content),
        "tables": {
            **addresses,
            "number_of_patterns": len(shapes),
            "number_of_edges": len(edges),
        },
        "patterns": {name: row for row, name in enumerate(patterns)},
        "polygons": {name: len(vertices) for name, vertices in POLYGONS.items()},
        "full_turn": TURNS,
        "algorithms": [names[number].lower().replace("_", "-") for number in sorted(names)],
    }
