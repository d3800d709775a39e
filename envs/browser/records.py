"""What entries find at their addresses."""

import numpy as np

from ...physics.kernels.layouts import record_dtype
from ..draw.canvas import Drawn
from ..draw.view import View
from ..rules import CELLS
from ..tensors.arrays import Arrays

# The numbers of channels that a picture may have: brightness; red, green and blue; these and
# opacity, as a canvas takes them.
CHANNELS = (1, 3, 4)
# The most layers of a network between observation and outputs.
MAX_LAYERS = 8

# A game. Its arrays are those of one world; they come first, so both have one address.
Game = record_dtype(
    [
        ("arrays", Arrays),
        ("seed", np.uint64),  # of random numbers, for `seed`
        ("velocity", np.float64, (2,)),  # and fire, for `steer`
        ("checksum", np.int64),  # of the states so far, in 32 bits
    ]
)

# A picture of a game, of any size.
Picture = record_dtype(
    [
        ("worlds", np.int64),  # `World` [1]
        ("rules", np.int64),  # `Rules` [1]
        ("palettes", np.int64, (2, max(CHANNELS) + 1)),  # of large and small pictures, by channels
        ("num_colours", np.int64),
        ("height", np.int64),
        ("width", np.int64),
        ("channels", np.int64),  # one of `CHANNELS`
        ("memory", np.int64),  # for the pixels, and what is drawn once
        ("length", np.int64),  # of it, in bytes
        ("place", View),
        ("drawn", Drawn),
    ]
)

# A level on the drawing board.
Board = record_dtype(
    [
        ("seed", np.int64),
        ("difficulty", np.float64),
        # What the generator shall make, see `Recipe`.
        ("motif", np.int64),
        ("rows", np.int64),
        ("density", np.float64),
        ("symmetry", np.int64),
        ("silver", np.float64),
        ("gold", np.float64),
        ("breakable", np.int64),  # how many bricks can be broken
        ("unreachable", np.int64),  # how many of them no ball can come to
        ("kind", np.uint8, (CELLS,)),
        ("blocked", np.uint8, (CELLS,)),  # 1: a brick that no ball can come to
    ]
)

# Bytes whose checksum is taken.
Block = record_dtype(
    [
        ("address", np.int64),
        ("length", np.int64),  # in bytes
        ("checksum", np.int64),  # so far, in 32 bits
    ]
)

# A network of an actor and a critic, each of as many layers, and what it says of an observation.
Network = record_dtype(
    [
        ("observation", np.int64),  # float32 [widths[0]]
        ("weights", np.int64),  # float32: of each layer of the actor [inputs + 1, outputs], the
        # last row being the bias; then those of the critic
        ("scratch", np.int64),  # float32 [2, largest width]
        ("layers", np.int64),
        ("widths", np.int64, (MAX_LAYERS + 1,)),  # the actor's; the critic's last one is 1
        ("activation", np.int64),  # between layers, one of `network.ACTIVATIONS`
        ("outputs", np.int64),  # float32 [widths[layers]]: logits, or the means of a box
        ("probabilities", np.int64),  # float64, the same length: of each discrete action
        ("action", np.int64),  # the likeliest
        ("value", np.float64),
    ]
)
