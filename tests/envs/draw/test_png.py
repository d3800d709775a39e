"""PNG files, read back by another library."""

import imageio.v3 as iio
import numpy as np
import pytest
from arkanoid.envs.draw.png import png_bytes


@pytest.mark.parametrize("shape", [(1, 1, 3), (7, 5, 3), (64, 33, 1), (48, 36, 3)])
def test_a_png_is_read_back_as_it_was(shape: tuple[int, int, int]) -> None:
    picture = np.random.default_rng(1).integers(0, 256, shape).astype(np.uint8)
    read = iio.imread(png_bytes(picture), extension=".png")
    np.testing.assert_array_equal(read.reshape(shape), picture)
