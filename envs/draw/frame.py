"""A world drawn into a picture, layer by layer, from the back to the front."""

from ...physics.kernels import kernel
from ..state import RulesRecord, WorldRecord
from .bricks import begin_picture, draw_bricks, erase_things
from .canvas import DrawnRecord, Lines
from .foes import draw_boss, draw_enemies, draw_shards
from .header import draw_header
from .player import draw_balls, draw_beams, draw_falling_capsule, draw_paddle
from .raster import Image
from .scenery import Scenery
from .status import draw_status
from .walls import draw_exit, draw_gates


@kernel
def draw_frame(
    picture: Image,
    lines: Lines,
    drawn: DrawnRecord,
    scenery: Scenery,
    world: WorldRecord,
    rules: RulesRecord,
) -> None:
    """Make a picture show a world; only what has changed is drawn.

    Args:
        picture: uint8 [height, width, channels], contiguous; lines: the same bytes.
        drawn: what the picture shows: zeros for a new picture, otherwise as the latest call for
            this picture left it.
        scenery: of the picture's size; world: `World` record; rules: `Rules` record.
    """
    if drawn.begun == 0:
        begin_picture(lines, drawn, scenery)
    erase_things(lines, drawn, scenery, world)
    draw_bricks(lines, drawn, scenery, world)
    # No thing is drawn below the field's lower edge, or over the status.
    image = picture[: scenery.views[0].ground]
    draw_gates(image, drawn, scenery, world)
    draw_exit(image, drawn, scenery, world)
    draw_boss(image, drawn, scenery, world, rules)
    draw_enemies(image, drawn, scenery, world, rules)
    draw_shards(image, drawn, scenery, world, rules)
    draw_falling_capsule(image, drawn, scenery, world)
    draw_beams(image, drawn, scenery, world)
    draw_paddle(image, drawn, scenery, world, rules)
    draw_balls(image, drawn, scenery, world)
    if scenery.views[0].header == 1:
        draw_header(image, lines, drawn, scenery, world)
    else:
        draw_status(picture, lines, drawn, scenery, world, rules)
