"""One world drawn into a picture, as a list of layers, from the back to the front."""

from typing import Any

from ...physics.kernels import kernel
from .bricks import begin_picture, draw_bricks, erase_things
from .foes import draw_boss, draw_enemies, draw_shards
from .header import draw_header
from .player import draw_balls, draw_beams, draw_falling_capsule, draw_paddle
from .raster import last_pixel
from .walls import draw_exit, draw_gates


@kernel
def draw_frame(picture: Any, lines: Any, drawn: Any, sheets: Any, world: Any, rules: Any) -> None:
    """Make a picture show a world; only what it shows otherwise is drawn.

    Args:
        picture: uint8 [height, width, channels], contiguous; lines: the same bytes, uint8
            [height, width * channels].
        drawn: what the picture shows, a `Drawn` record: zeros if it means nothing, else as the
            latest call for this picture has left it.
        sheets: the `Scenery` of the picture's size; world: `World` record; rules: `Rules` record.
    """
    if drawn.begun == 0:
        begin_picture(lines, drawn, sheets)
    erase_things(lines, drawn, sheets, world)
    draw_bricks(lines, drawn, sheets, world)
    # What leaves the field at its lower edge is not seen below it.
    image = picture[: last_pixel(sheets.views[0].bottom, picture.shape[0])]
    draw_gates(image, drawn, sheets, world)
    draw_exit(image, drawn, sheets, world)
    draw_boss(image, drawn, sheets, world, rules)
    draw_enemies(image, drawn, sheets, world, rules)
    draw_shards(image, drawn, sheets, world, rules)
    draw_falling_capsule(image, drawn, sheets, world)
    draw_beams(image, drawn, sheets, world)
    draw_paddle(image, drawn, sheets, world, rules)
    draw_balls(image, drawn, sheets, world)
    if sheets.views[0].header == 1:
        draw_header(image, lines, drawn, sheets, world)
