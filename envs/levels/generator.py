"""Levels without end, each from a seed: drawn in place, always clearable, the same everywhere.

A seed and a difficulty make a `Recipe` (motif, size, density, symmetry, metal), and a seed and a
recipe a level. All numbers are taken by their place (`noise.py`), so that whoever fixes one part of
a recipe changes no other. A level is drawn in four passes over its own cells: how strong the motif
is there; a brick where it is strongest; how fit a brick is for metal; its colour or metal. In the
end golden bricks that bar the way to others are opened, as few as it needs.
"""

from typing import Any, NamedTuple

from ...physics.kernels import kernel
from ..rules import CELLS, COLOURS, COLUMNS, EMPTY, GOLD, SILVER
from .clearability import borders_reached, clear_marks, count_unreached, mark_reachable
from .motifs import MOTIF_COUNT, motif_at, zigzag
from .noise import noise, noise_key

# Agents train on these levels ...
TRAIN_SEEDS = range(10_000)
# ... and never on those of seeds from this one on, on which they are tested.
FIRST_TEST_SEED = 1_000_000
MAX_SEED = 2**63 - 1

MIN_ROWS, MAX_ROWS = 4, 12
MIN_DENSITY, MAX_DENSITY = 0.35, 0.9  # bricks by cells of the rows
MAX_SILVER = 0.3  # of the bricks
MAX_GOLD = 0.15  # of the bricks

# Which cells show the same brick.
NO_SYMMETRY = 0
MIRROR = 1  # left and right
TURN = 2  # by half a turn
BOTH = 3  # left and right, and up and down
SYMMETRIES = {"none": NO_SYMMETRY, "mirror": MIRROR, "turn": TURN, "both": BOTH}

# The places of a level's numbers in the noise of its seed.
_MOTIF, _SYMMETRY, _ROWS, _DENSITY, _SILVER, _GOLD, _TOP, _PALETTE, _METAL, _GRAIN = range(10)
_STYLE, _TINT = 10, 16
_GRAIN_AT = 100
_METAL_AT = 400
_LAYERS_AT = 700

# From seed to seed a recipe strays this far (half of it up, half down) from its difficulty's.
_SPREAD = 0.4
# The parts of difficulty at which metal sets in.
_SILVER_FROM = 0.15
_GOLD_FROM = 0.35
# While a level is drawn a cell holds a number from 1 to this; the two above it are a threshold that
# none holds, and the mark of those that were chosen as gold.
_HIGHEST = 253
_GOLDEN = 255
# The steps through the eight colours from layer to layer: those that pass all of them.
_COLOUR_STEPS = 4


class Recipe(NamedTuple):
    """What a level is made to, beside its seed.

    Attributes:
        motif: index of `MOTIFS`.
        rows: of the lattice that the bricks lie in, 4 to 12.
        density: the part of those rows' cells that hold bricks, 0.35 to 0.9.
        symmetry: one of `SYMMETRIES`.
        silver: the part of the bricks that are silver, 0 to 0.3.
        gold: the part of the bricks that are gold at the most, 0 to 0.15.
    """

    motif: int
    rows: int
    density: float
    symmetry: int
    silver: float
    gold: float


@kernel
def generate_level(kinds: Any, seed: int, difficulty: float) -> None:
    """Write the level of a seed >= 0 and a difficulty in [0, 1] into kinds, uint8 [CELLS]."""
    lay_level(kinds, seed, plan_level(seed, difficulty))


@kernel
def plan_level(seed: int, difficulty: float) -> Recipe:
    """Return the recipe of a seed and a difficulty (which is brought into [0, 1])."""
    key = noise_key(seed)
    difficulty = min(max(difficulty, 0.0), 1.0)
    rows = _strayed(difficulty, noise(key, _ROWS))
    density = _strayed(difficulty, noise(key, _DENSITY))
    silver = max(0.0, _strayed(difficulty, noise(key, _SILVER)) - _SILVER_FROM)
    gold = max(0.0, _strayed(difficulty, noise(key, _GOLD)) - _GOLD_FROM)
    # Order gives way to disorder: from one level in 20 without symmetry to one in 2.
    symmetry = NO_SYMMETRY
    if noise(key, _SYMMETRY) >= 0.05 + 0.45 * difficulty:
        part = noise(key, _SYMMETRY + _LAYERS_AT)
        symmetry = MIRROR if part < 0.6 else (BOTH if part < 0.85 else TURN)
    return Recipe(
        int(noise(key, _MOTIF) * MOTIF_COUNT),
        MIN_ROWS + int(rows * (MAX_ROWS - MIN_ROWS) + 0.5),
        MIN_DENSITY + density * (MAX_DENSITY - MIN_DENSITY),
        symmetry,
        silver / (1.0 - _SILVER_FROM) * MAX_SILVER,
        gold / (1.0 - _GOLD_FROM) * MAX_GOLD,
    )


@kernel
def lay_level(kinds: Any, seed: int, recipe: Recipe) -> None:
    """Write the level that a recipe makes of a seed >= 0 into kinds, uint8 [CELLS]."""
    key = noise_key(seed)
    first = _rows_above(key) * COLUMNS
    for cell in range(CELLS):
        kinds[cell] = EMPTY
    # The cells of the recipe's rows; a view of the level, not a copy.
    part = kinds[first : first + recipe.rows * COLUMNS]
    _draw_strengths(part, key, recipe)
    bricks = _lay_bricks(part, key, recipe)
    _colour_bricks(part, key, recipe, bricks)
    _open_gold(kinds, part, key, recipe)


@kernel
def _strayed(difficulty: float, chance: float) -> float:
    """Return a difficulty from which a recipe strays by chance, in [0, 1]."""
    return min(max(difficulty + _SPREAD * (chance - 0.5), 0.0), 1.0)


@kernel
def _rows_above(key: Any) -> int:
    """Return how many rows of the lattice are free above the bricks: room to play behind them."""
    return 1 + int(noise(key, _TOP) * 4.0)


@kernel
def original(symmetry: int, rows: int, cell: int) -> int:
    """Return the cell, of a recipe's rows, whose brick a cell repeats (its own if it is one)."""
    row, column = cell // COLUMNS, cell % COLUMNS
    if symmetry == TURN:
        return min(cell, rows * COLUMNS - 1 - cell)
    if symmetry != NO_SYMMETRY:
        column = min(column, COLUMNS - 1 - column)
    if symmetry == BOTH:
        row = min(row, rows - 1 - row)
    return row * COLUMNS + column


@kernel
def _style(key: Any) -> tuple[float, float, float, float, float, float]:
    """Return the six numbers that tell the levels of one motif apart."""
    return (
        noise(key, _STYLE),
        noise(key, _STYLE + 1),
        noise(key, _STYLE + 2),
        noise(key, _STYLE + 3),
        noise(key, _STYLE + 4),
        noise(key, _STYLE + 5),
    )


@kernel
def _motif_of_cell(
    key: Any, recipe: Recipe, style: tuple[float, ...], cell: int
) -> tuple[float, int]:
    """Return (strength, layer) of the motif at a cell of the recipe's rows."""
    x = cell % COLUMNS - (COLUMNS - 1) / 2
    y = (cell // COLUMNS - (recipe.rows - 1) / 2) / 2
    return motif_at(recipe.motif, style, key, x, y)


@kernel
def _digit(part: float) -> int:
    """Return a number from 1 to `_HIGHEST` for one from 0 to 1, to be kept in a cell."""
    return 1 + int(part * (_HIGHEST - 1))


@kernel
def _draw_strengths(part: Any, key: Any, recipe: Recipe) -> None:
    """Write how strong the motif is, with a grain, as numbers into the cells of the rows."""
    style = _style(key)
    grain = noise(key, _GRAIN)
    grain = 0.05 + 0.2 * grain * grain
    for cell in range(part.shape[0]):
        source = original(recipe.symmetry, recipe.rows, cell)
        strength, _ = _motif_of_cell(key, recipe, style, source)
        chance = noise(key, _GRAIN_AT + source)
        part[cell] = _digit((1.0 - grain) * strength + grain * chance)


@kernel
def _count_from(part: Any, threshold: int) -> int:
    """Return how many cells hold a threshold or more."""
    count = 0
    for cell in range(part.shape[0]):
        if part[cell] >= threshold:
            count += 1
    return count


@kernel
def _least_threshold(part: Any, wanted: int) -> int:
    """Return the least number that at most so many cells hold, or more than it, from 1 on."""
    low, high = 1, _HIGHEST + 1
    while low < high:
        middle = (low + high) // 2
        if _count_from(part, middle) <= wanted:
            high = middle
        else:
            low = middle + 1
    return low


@kernel
def _images(symmetry: int, rows: int, cell: int) -> int:
    """Return how many cells show the same brick as an original does, itself included."""
    row, column = cell // COLUMNS, cell % COLUMNS
    if symmetry == NO_SYMMETRY:
        return 1
    if symmetry == TURN:
        return 1 if 2 * cell == rows * COLUMNS - 1 else 2
    images = 1 if 2 * column == COLUMNS - 1 else 2
    return images if symmetry == MIRROR or 2 * row == rows - 1 else 2 * images


@kernel
def _choose(part: Any, recipe: Recipe, wanted: int, nearest: bool) -> int:
    """Return a threshold that as many cells as wanted hold, or more than it.

    A brick and its images come together, so that the number may be missed by some: the nearest
    number is chosen, or else the nearest that is not more.
    """
    threshold = _least_threshold(part, wanted)
    count = _count_from(part, threshold)
    # Of those that are equal, and too many, the first ones are lifted.
    for cell in range(part.shape[0]):
        if part[cell] == threshold - 1 and original(recipe.symmetry, recipe.rows, cell) == cell:
            images = _images(recipe.symmetry, recipe.rows, cell)
            if 2 * (count + images) <= 2 * wanted + (images if nearest else 0):
                count += images
                for image in range(cell, part.shape[0]):
                    if original(recipe.symmetry, recipe.rows, image) == cell:
                        part[image] = threshold
    return threshold


@kernel
def _lay_bricks(part: Any, key: Any, recipe: Recipe) -> int:
    """Turn strengths into bricks (1 and up: how fit for metal) and gaps (0); return the bricks."""
    threshold = _choose(part, recipe, int(recipe.density * part.shape[0] + 0.5), True)
    style = _style(key)
    manner = noise(key, _METAL)
    bricks = 0
    for cell in range(part.shape[0]):
        if part[cell] < threshold:
            part[cell] = EMPTY
            continue
        bricks += 1
        source = original(recipe.symmetry, recipe.rows, cell)
        fitness = _fitness(key, recipe, style, manner, source)
        part[cell] = _digit(fitness)
    return bricks


@kernel
def _fitness(key: Any, recipe: Recipe, style: tuple[float, ...], manner: float, cell: int) -> float:
    """Return how fit a brick is for metal, from 0 to 1, in the manner that the level has."""
    strength, layer = _motif_of_cell(key, recipe, style, cell)
    chance = noise(key, _METAL_AT + cell)
    if manner < 0.35:  # some layers
        fitness = noise(key, _LAYERS_AT + layer)
    elif manner < 0.55:  # the layers' middles
        fitness = strength
    elif manner < 0.7:  # the lowest bricks, in heaps: a whole row of gold is no fun
        row, column = cell // COLUMNS, cell % COLUMNS
        fitness = 0.7 * row / recipe.rows + 0.3 * zigzag((column + 1.0) / 4.0)
    elif manner < 0.85:  # columns
        fitness = zigzag((cell % COLUMNS + 1.0) * (1.0 + int(6.0 * style[5])) / 12.0)
    else:  # anywhere
        fitness = chance
    return 0.9 * fitness + 0.1 * chance


@kernel
def _colour_bricks(part: Any, key: Any, recipe: Recipe, bricks: int) -> None:
    """Turn the fittest bricks into gold, the next ones into silver, and colour the others."""
    golden = 0
    gold_from = _choose(part, recipe, int(recipe.gold * bricks), False)
    for cell in range(part.shape[0]):
        if part[cell] >= gold_from:
            part[cell] = _GOLDEN
            golden += 1
    silver_from = _choose(part, recipe, golden + int(recipe.silver * bricks), False)
    style = _style(key)
    for cell in range(part.shape[0]):
        if part[cell] == EMPTY:
            continue
        if part[cell] == _GOLDEN:
            part[cell] = GOLD
        elif part[cell] >= silver_from:
            part[cell] = SILVER
        else:
            part[cell] = _colour(key, recipe, style, cell)


@kernel
def _colour(key: Any, recipe: Recipe, style: tuple[float, ...], cell: int) -> int:
    """Return the colour of a brick's layer, in some levels changing along or across it."""
    source = original(recipe.symmetry, recipe.rows, cell)
    _, layer = _motif_of_cell(key, recipe, style, source)
    choice = int(noise(key, _PALETTE) * COLOURS * _COLOUR_STEPS)
    start, step = choice % COLOURS, 2 * (choice // COLOURS) + 1
    tint = noise(key, _TINT)
    if tint < 0.15:
        layer += source // COLUMNS // 2
    elif tint < 0.3:
        layer += source % COLUMNS // 2
    return 1 + (start + layer * step) % COLOURS


@kernel
def _recolour(part: Any, key: Any, recipe: Recipe, cell: int) -> None:
    """Turn a golden brick and its images into coloured ones."""
    style = _style(key)
    first = original(recipe.symmetry, recipe.rows, cell)
    for image in range(part.shape[0]):
        if original(recipe.symmetry, recipe.rows, image) == first:
            part[image] = _colour(key, recipe, style, image)


@kernel
def _open_gold(kinds: Any, part: Any, key: Any, recipe: Recipe) -> None:
    """Colour as many golden bricks as bar the only ways to others, one and its images at a time."""
    mark_reachable(kinds)
    while count_unreached(kinds) > 0:
        _recolour(part, key, recipe, _bar(kinds, part, key, recipe))
        mark_reachable(kinds)
    clear_marks(kinds)


@kernel
def _bar(kinds: Any, part: Any, key: Any, recipe: Recipe) -> int:
    """Return a golden cell of the rows that bars a way; one with a brick behind if there is."""
    first = _rows_above(key) * COLUMNS
    best, found = -1.0, -1
    for cell in range(part.shape[0]):
        if part[cell] == GOLD and borders_reached(kinds, first + cell):
            fitness = noise(key, _GRAIN_AT + original(recipe.symmetry, recipe.rows, cell))
            if _borders_unreached(kinds, first + cell):
                fitness += 1.0
            if fitness > best:
                best, found = fitness, cell
    return found


@kernel
def _borders_unreached(kinds: Any, cell: int) -> bool:
    """Tell whether a breakable brick that is out of reach lies at a side of a cell."""
    column = cell % COLUMNS
    return bool(
        (cell >= COLUMNS and _unreached(kinds[cell - COLUMNS]))
        or (cell < CELLS - COLUMNS and _unreached(kinds[cell + COLUMNS]))
        or (column > 0 and _unreached(kinds[cell - 1]))
        or (column < COLUMNS - 1 and _unreached(kinds[cell + 1]))
    )


@kernel
def _unreached(kind: int) -> bool:
    """Tell whether a marked level's cell holds a breakable brick out of reach."""
    return EMPTY < kind < GOLD
