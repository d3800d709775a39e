"""The game for browsers: its kernels as WebAssembly, an image of its memory, and what names both.

`entries` are what a browser calls. `image` lays out what they work on, and `manifest` says where
each number lies, so that JavaScript (``game.js``) knows names and no numbers.
"""
