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

# A game. Its arrays are those of one world; they come first, so both have one address.
Game = record_dtype(
    [
        ("arrays", Arrays),
        ("seed", np.uint64),  # of random numbers, for `seed`
        ("velocity", np.float64, (2,)),  # and fire, for `steer`
        ("checksum", np.int64),  # of the states so far, in 32 bits
        ("paddle", np.float64),  # factor on the paddle's width, for `fit`
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

# A tick of a game, for ears.
Hearing = record_dtype(
    [
        ("before", np.int64),  # `World` [1]
        ("after", np.int64),  # `World` [1]
        ("outcome", np.int64),  # `Outcome` [1]
        ("tones", np.int64),  # that are heard, as bits
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

# One operation of a network over the numbers of its memory, which are counted from the first weight
# on: what the network computes has negative places.
Operation = record_dtype(
    [
        ("kind", np.int64),  # one of those of `operations`
        ("target", np.int64),  # the place of its first result
        ("count", np.int64),  # of its results; of a convolution, their channels
        ("operands", np.int64, (3,)),  # the places of what it reads
        ("steps", np.int64, (3,)),  # between two numbers of each operand; 0: always the same
        ("sizes", np.int64, (3,)),  # of what is read
        ("window", np.int64),  # of a convolution: rows and columns that it sees at once
        ("stride", np.int64),
        ("padding", np.int64),
    ]
)

# A network of an actor and a critic, and what it says of an observation.
Network = record_dtype(
    [
        ("observation", np.int64),  # float32 [inputs], or uint8 [pictures, pixels, channels]
        ("inputs", np.int64),  # numbers of the observation
        ("pictures", np.int64),  # that it shows; 0: it is no picture
        ("channels", np.int64),  # of a picture
        ("weights", np.int64),  # float32; before them lies what is computed, at first the inputs
        ("operations", np.int64),  # `Operation` [num_operations]
        ("num_operations", np.int64),
        ("outputs", np.int64),  # the place of the logits, or of the means of a box
        ("num_outputs", np.int64),
        ("worth", np.int64),  # the place of the value
        ("probabilities", np.int64),  # float64 [num_outputs]: of each discrete action
        ("action", np.int64),  # the likeliest
        ("value", np.float64),
    ]
)
