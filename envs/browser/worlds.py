"""What the manifest says of worlds to throw things in."""

from base64 import b64encode
from typing import Any

from ...physics.scenes import sandbox
from ...physics.scenes.patterns import POLYGONS
from ...physics.scenes.ready import SCENES, Thing, text_of
from ...physics.scenes.records import MAX_EDGES, RAYS, Seen
from ...physics.world.memory.setup import Room, Setup
from ...physics.world.state.records import BEGIN, END, HIT, Hit, Inside, Pair, Ray

ROOM = 1024  # bodies
MAX_HITS = 10_000  # of one body in one step, as `World` has it
PAIRS = 4 * ROOM  # of a sensor and a body inside
HITS = 2 * PAIRS  # that are told at once; more than may be inside


def describe_worlds() -> dict[str, Any]:
    """Return how a sandbox lies in memory, what its numbers mean, and scenes that are ready."""
    room = Room(bodies=ROOM, movers=ROOM, shapes=ROOM + 1, edges=MAX_EDGES * ROOM)
    setup = Setup(room, MAX_HITS, rest_speed=0.0, continuous=True)
    header = setup.header
    header.shapes, header.edges = room.shapes, room.edges
    size = int(header.nbytes)
    return {
        "header": b64encode(setup.workspace[:size].tobytes()).decode(),
        # The blocks that change, in bytes; then the memory for what is asked and answered.
        "blocks": {
            "workspace": len(setup.workspace),
            "state": int(header.state_size),
            "inside": Inside.itemsize + 8 * ROOM + Pair.itemsize * PAIRS,
        },
        "tables": {
            "hits": Hit.itemsize * HITS,
            "call": 8 * sandbox.CALL,
            "found": 8 * ROOM,
            "scratch": 8 * ROOM,
            "bodies": Seen.itemsize * ROOM,
            "rays": Ray.itemsize * RAYS,
        },
        "numbers": {"pairs": PAIRS, "hits_room": HITS, "room": ROOM},
        "rays": RAYS,
        "kinds": {"HIT": HIT, "BEGIN": BEGIN, "END": END},
        "outcomes": {name: getattr(sandbox, name) for name in ("DONE", "MORE", "CROWDED", "LOST")},
        "polygons": POLYGONS,
        "thing": Thing._field_defaults,
        "scenes": {
            name: {
                "title": scene.title,
                "says": scene.says,
                "gravity": scene.gravity,
                "lamp": scene.lamp,
                "things": [text_of(thing) for thing in scene.things],
            }
            for name, scene in SCENES.items()
        },
    }
