"""The game in a window: played by hand, or a recorded game that is shown.

Others use `by_hand` for the command `arkanoid play` and replays, `gallery` for pictures of levels,
`window.Window` and `show.screen_height` for rendering, and `controls.keys_to_action`.
"""
