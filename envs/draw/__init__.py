"""Pictures of a world, drawn by kernels without a display.

Others use `picture.draw_world` for a fresh picture; `frame.draw_frame`, `scenery.make_scenery` and
`canvas.Drawn` for a picture that is kept up to date; `overlay.draw_overlay`, `png.write_png`, the
sizes in `view` and the colours in `palette`.
"""
