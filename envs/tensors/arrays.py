"""What an entry finds at its address: the arrays of a batch, and how to play it."""

import numpy as np

from ...physics.kernels.layouts import record_dtype

CHANNELS = 3  # at most, of a picture

# Addresses and numbers, all int64. A pointer to an array of all worlds is followed by what else is
# needed to find a world's part of it.
Arrays = record_dtype(
    [
        # The game. Which array has which dtype is written in `entries`.
        ("worlds", np.int64),
        ("rules", np.int64),
        ("levels", np.int64),
        ("num_levels", np.int64),
        ("outcomes", np.int64),
        # What is commanded: int64 [n], or float32 [n, 2] if there is no table.
        ("actions", np.int64),
        ("table", np.int64),  # float64 [num_actions, 2]; 0: there is none
        ("num_actions", np.int64),
        ("commands", np.int64),
        ("illegal", np.int64),  # int32 [n], how many illegal actions each world was given
        ("autoreset", np.int64),  # of `Autoreset`
        ("episodic_life", np.int64),
        # The results of a step, and with same-step autoreset those that its reset replaced.
        ("count", np.int64),  # n
        ("rewards", np.int64),
        ("terminated", np.int64),
        ("truncated", np.int64),
        ("infos", np.int64),  # int64 [fields, n]
        ("final_infos", np.int64),
        ("finals", np.int64),
        # Vectors.
        ("vectors", np.int64),
        ("final_vectors", np.int64),
        ("vector_size", np.int64),
        ("vector_shown", np.int64),
        ("plain_length", np.int64),
        ("landings_start", np.int64),  # 0: there are none
        ("scratch", np.int64),
        # Grids.
        ("grids", np.int64),
        ("final_grids", np.int64),
        ("grid_size", np.int64),
        ("grid_shown", np.int64),
        ("marks", np.int64),
        # Pictures: uint8 [n, stack, channels, height, width].
        ("pictures", np.int64),
        ("final_pictures", np.int64),
        ("drawn", np.int64),
        ("stack", np.int64),
        ("channels", np.int64),
        ("height", np.int64),
        ("width", np.int64),
        # Of `Scenery`, by channel.
        ("views", np.int64),
        ("palettes", np.int64, (CHANNELS,)),
        ("backgrounds", np.int64, (CHANNELS,)),
        ("looks", np.int64, (CHANNELS,)),
        ("num_colours", np.int64),
        ("num_looks", np.int64),
        ("look_rows", np.int64),
        ("look_columns", np.int64),
        # A mask of one world, which is in it.
        ("here", np.bool_),
    ]
)
HERE = int(Arrays.fields["here"][1])  # type: ignore[index]
