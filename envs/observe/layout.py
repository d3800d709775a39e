"""Named parts of an observation."""


def slices(sizes: dict[str, int], start: int) -> dict[str, slice]:
    """Return a slice for each name, of its size, one after the other from a start on."""
    layout = {}
    for name, size in sizes.items():
        layout[name] = slice(start, start + size)
        start += size
    return layout
