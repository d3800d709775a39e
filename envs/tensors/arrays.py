"""What an entry finds at its address: the arrays of a batch, and how to play it."""

import numpy as np

from ...physics.kernels.layouts import record_dtype

CHANNELS = 3  # at most, of a picture

# Addresses and numbers, all int64. A pointer to an array of all worlds is followed by what else is
# needed to find a world's part of it.
Arrays = record_dtype(
    [
        # The game.
        ("worlds", np.int64),  # `World` [n]
        ("outcomes", np.int64),  # `Outcome` [n]
        ("rules", np.int64),  # `Rules` [1]
        ("levels", np.int64),  # `LevelEntry` [num_levels]
        ("num_levels", np.int64),
        # What is commanded: int64 [n], or float32 [n, 2] if there is no table.
        ("actions", np.int64),
        ("table", np.int64),  # float64 [num_actions, 2]; 0: there is none
        ("num_actions", np.int64),
        ("commands", np.int64),  # float64 [n, 2]
        ("illegal", np.int64),  # int32 [n], how many illegal actions each world was given
        ("autoreset", np.int64),  # of `Autoreset`
        ("episodic_life", np.int64),
        # The results of a step.
        ("count", np.int64),  # n
        ("rewards", np.int64),  # float64 [n]
        ("terminated", np.int64),  # bool [n]
        ("truncated", np.int64),  # bool [n]
        ("infos", np.int64),  # int64 [fields, n]
        ("final_infos", np.int64),  # the same of episodes that ended, in same-step mode
        ("moves", np.int64),  # uint8 [n], what became of each world, see `entries`
        # Vectors, float32 [n, vector_size].
        ("vectors", np.int64),
        ("final_vectors", np.int64),
        ("vector_size", np.int64),
        ("vector_shown", np.int64),  # int64 [n, 3]
        ("plain_length", np.int64),
        ("landings_start", np.int64),  # 0: there are none
        # Grids, float32 [n, grid_size].
        ("grids", np.int64),
        ("final_grids", np.int64),
        ("grid_size", np.int64),
        ("grid_shown", np.int64),  # int64 [n, 3]
        ("marks", np.int64),  # int32 [n, 1 + MAX_MARKS]
        # Pictures, uint8 [n, stack, channels, height, width], and the newest of each world.
        ("pictures", np.int64),
        ("final_pictures", np.int64),
        ("canvas", np.int64),  # uint8 [n, channels, height, width]
        ("drawn", np.int64),  # `Drawn` [n, channels]
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
