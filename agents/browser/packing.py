"""What a page holds, as text: deflated, and 7 bits a letter.

Base64 has 6 bits a letter. The first 128 letters are one byte of UTF-8 each, so 7 bits fit in.
HTML does not keep two of them, and reads a third as the beginning of a tag: 128 is added to these.
``markup/unpack.js`` has the way back.
"""

import zlib

import numpy as np

_BITS = 7
_MOVED = {code: code + 128 for code in b"\0\r<"}


def pack(content: bytes) -> str:
    """Return the content of an element of the page: bytes that are not 0, as letters."""
    bits = np.unpackbits(np.frombuffer(zlib.compress(content, 9), np.uint8))
    rows = np.pad(bits, (0, -len(bits) % _BITS)).reshape(-1, _BITS)
    # `packbits` leaves the last bit of each byte 0, and it is the first that letters do not have.
    letters = np.packbits(rows, axis=1) >> 1
    return letters.tobytes().decode("ascii").translate(_MOVED)


def split_planes(numbers: bytes, width: int) -> bytes:
    """Return the first bytes of all numbers, then all second bytes, and so on.

    The exponents of weights are alike, the other bytes are not: apart, they take a tenth less.

    Args:
        numbers: each of `width` bytes; the last one may be cut.
    """
    return b"".join(numbers[place::width] for place in range(width))
