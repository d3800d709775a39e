"""Endless levels, one per seed and difficulty: always clearable, and the same on every machine.

A seed and a difficulty make a `Recipe` (motif, size, density, symmetry, metal); the seed and the
recipe make the level. All random numbers are found by their index (`noise.py`): whoever fixes one
part of a recipe changes no other part. A level is drawn in four passes over its own cells: how
strong the motif is in each cell; a brick where it is strongest; how well each brick suits metal;
the brick's colour or metal. At last, as few golden bricks as needed are coloured, so that the ball
can come to every brick.
"""

from typing import NamedTuple

import numpy as np

from ...physics.kernels import kernel
from ..rules import CELLS, COLOURS, COLUMNS, EMPTY, GOLD, SILVER
from .clearability import Kinds, borders_reached, clear_search, count_unreached, search_reachable
from .motifs import MOTIF_COUNT, motif_at, zigzag
from .noise import noise, noise_key

# Agents train on these levels ...
TRAIN_SEEDS = range(10_000)
# ... and are tested on the levels of the seeds from this one on, on which nothing trains.
FIRST_TEST_SEED = 1_000_000
MAX_SEED = 2**63 - 1

MIN_ROWS, MAX_ROWS = 4, 12
MIN_DENSITY, MAX_DENSITY = 0.35, 0.9  # bricks per cell of the rows
MAX_SILVER = 0.3  # of the bricks
MAX_GOLD = 0.15  # of the bricks

# Which cells are copies of each other.
NO_SYMMETRY = 0
MIRROR = 1  # left and right
TURN = 2  # by half a turn
BOTH = 3  # left and right, and up and down
SYMMETRIES = {"none": NO_SYMMETRY, "mirror": MIRROR, "turn": TURN, "both": BOTH}

# The indices of a level's numbers in the noise of its seed.
_MOTIF, _SYMMETRY, _ROWS, _DENSITY, _SILVER, _GOLD, _TOP, _PALETTE, _METAL, _GRAIN = range(10)
_STYLE, _TINT = 10, 16
_GRAIN_AT = 100
_METAL_AT = 400
_LAYERS_AT = 700

# Each part of a recipe may differ by this much (half of it up, half down) from its difficulty.
_SPREAD = 0.4
# The difficulties from which on there is metal.
_SILVER_FROM = 0.15
_GOLD_FROM = 0.35
# While a level is drawn, a cell holds a number from 1 to this. One more is a threshold that no cell
# reaches; `_GOLDEN` marks the cells that become gold.
_HIGHEST = 253
_GOLDEN = 255
# How many steps from layer to layer visit all eight colours: the odd ones, 1, 3, 5 and 7.
_COLOUR_STEPS = 4


class Recipe(NamedTuple):
    """What a level shall be like.

    Attributes:
        motif: index of `MOTIFS`.
        rows: rows of cells in which the bricks lie, 4 to 12.
        density: the fraction of those cells that hold bricks, 0.35 to 0.9.
        symmetry: one of `SYMMETRIES`.
        silver: the fraction of the bricks that are silver, 0 to 0.3.
        gold: the largest fraction of the bricks that may be gold, 0 to 0.15.
    """

    motif: int
    rows: int
    density: float
    symmetry: int
    silver: float
    gold: float


@kernel
def lay_level(kinds: Kinds, seed: int, difficulty: float) -> None:
    """Write the level of a seed >= 0 and a difficulty in [0, 1] into kinds, uint8 [CELLS]."""
    lay_recipe(kinds, seed, make_recipe(seed, difficulty))


@kernel
def make_recipe(seed: int, difficulty: float) -> Recipe:
    """Return the recipe of a seed and a difficulty, which is clipped to [0, 1]."""
    key = noise_key(seed)
    difficulty = min(max(difficulty, 0.0), 1.0)
    rows = _jittered(difficulty, noise(key, _ROWS))
    density = _jittered(difficulty, noise(key, _DENSITY))
    silver = max(0.0, _jittered(difficulty, noise(key, _SILVER)) - _SILVER_FROM)
    gold = max(0.0, _jittered(difficulty, noise(key, _GOLD)) - _GOLD_FROM)
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
def lay_recipe(kinds: Kinds, seed: int, recipe: Recipe) -> None:
    """Write the level of a seed >= 0 and a recipe into kinds, uint8 [CELLS]."""
    key = noise_key(seed)
    first = _rows_above(key) * COLUMNS
    for cell in range(CELLS):
        kinds[cell] = EMPTY
    # A view of the level, not a copy.
    cells = kinds[first : first + recipe.rows * COLUMNS]
    _draw_strengths(cells, key, recipe)
    bricks = _lay_bricks(cells, key, recipe)
    _colour_bricks(cells, key, recipe, bricks)
    _open_gold(kinds, cells, key, recipe)


@kernel
def _jittered(difficulty: float, chance: float) -> float:
    """Return a difficulty shifted by chance (in [0, 1]), clipped to [0, 1]."""
    return min(max(difficulty + _SPREAD * (chance - 0.5), 0.0), 1.0)


@kernel
def _rows_above(key: np.uint64) -> int:
    """Return how many rows above the bricks are free, as room for the ball behind them."""
    return 1 + int(noise(key, _TOP) * 4.0)


@kernel
def original(symmetry: int, rows: int, cell: int) -> int:
    """Return the cell whose brick a cell copies; an original copies itself."""
    row, column = cell // COLUMNS, cell % COLUMNS
    if symmetry == TURN:
        return min(cell, rows * COLUMNS - 1 - cell)
    if symmetry != NO_SYMMETRY:
        column = min(column, COLUMNS - 1 - column)
    if symmetry == BOTH:
        row = min(row, rows - 1 - row)
    return row * COLUMNS + column


@kernel
def _style(key: np.uint64) -> tuple[float, float, float, float, float, float]:
    """Return the six numbers by which levels of one motif differ."""
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
    key: np.uint64, recipe: Recipe, style: tuple[float, ...], cell: int
) -> tuple[float, int]:
    """Return (strength, layer) of the motif at a cell of the recipe's rows."""
    x = cell % COLUMNS - (COLUMNS - 1) / 2
    y = (cell // COLUMNS - (recipe.rows - 1) / 2) / 2
    return motif_at(recipe.motif, style, key, x, y)


@kernel
def _quantized(part: float) -> int:
    """Return a number in [0, 1] as an integer from 1 to `_HIGHEST`, which a cell can hold."""
    return 1 + int(part * (_HIGHEST - 1))


@kernel
def _draw_strengths(cells: Kinds, key: np.uint64, recipe: Recipe) -> None:
    """Write into each cell how strong the motif is there, with some noise."""
    style = _style(key)
    grain = noise(key, _GRAIN)
    grain = 0.05 + 0.2 * grain * grain
    for cell in range(cells.shape[0]):
        source = original(recipe.symmetry, recipe.rows, cell)
        strength, _ = _motif_of_cell(key, recipe, style, source)
        chance = noise(key, _GRAIN_AT + source)
        cells[cell] = _quantized((1.0 - grain) * strength + grain * chance)


@kernel
def _count_from(cells: Kinds, threshold: int) -> int:
    """Return how many cells hold at least a threshold."""
    count = 0
    for cell in range(cells.shape[0]):
        if cells[cell] >= threshold:
            count += 1
    return count


@kernel
def _least_threshold(cells: Kinds, wanted: int) -> int:
    """Return the least threshold >= 1 that at most so many cells reach."""
    low, high = 1, _HIGHEST + 1
    while low < high:
        middle = (low + high) // 2
        if _count_from(cells, middle) <= wanted:
            high = middle
        else:
            low = middle + 1
    return low


@kernel
def _count_copies(symmetry: int, rows: int, cell: int) -> int:
    """Return how many cells hold the brick of an original cell, itself included."""
    row, column = cell // COLUMNS, cell % COLUMNS
    if symmetry == NO_SYMMETRY:
        return 1
    if symmetry == TURN:
        return 1 if 2 * cell == rows * COLUMNS - 1 else 2
    copies = 1 if 2 * column == COLUMNS - 1 else 2
    return copies if symmetry == MIRROR or 2 * row == rows - 1 else 2 * copies


@kernel
def _threshold_for(cells: Kinds, recipe: Recipe, wanted: int, nearest: bool) -> int:
    """Return a threshold that as many cells as wanted reach; some cells are raised to it.

    A brick and its copies come together, so the exact number may be impossible. Then it is the
    nearest possible number (`nearest`), or the nearest one that is not larger.
    """
    threshold = _least_threshold(cells, wanted)
    count = _count_from(cells, threshold)
    # Too many cells lie just below: raise the first ones.
    for cell in range(cells.shape[0]):
        if cells[cell] == threshold - 1 and original(recipe.symmetry, recipe.rows, cell) == cell:
            copies = _count_copies(recipe.symmetry, recipe.rows, cell)
            if 2 * (count + copies) <= 2 * wanted + (copies if nearest else 0):
                count += copies
                for copy in range(cell, cells.shape[0]):
                    if original(recipe.symmetry, recipe.rows, copy) == cell:
                        cells[copy] = threshold
    return threshold


@kernel
def _lay_bricks(cells: Kinds, key: np.uint64, recipe: Recipe) -> int:
    """Turn strengths into gaps and bricks (>= 1: how well it suits metal); count the bricks."""
    threshold = _threshold_for(cells, recipe, int(recipe.density * cells.shape[0] + 0.5), True)
    style = _style(key)
    manner = noise(key, _METAL)
    bricks = 0
    for cell in range(cells.shape[0]):
        if cells[cell] < threshold:
            cells[cell] = EMPTY
            continue
        bricks += 1
        source = original(recipe.symmetry, recipe.rows, cell)
        fitness = _fitness(key, recipe, style, manner, source)
        cells[cell] = _quantized(fitness)
    return bricks


@kernel
def _fitness(
    key: np.uint64, recipe: Recipe, style: tuple[float, ...], manner: float, cell: int
) -> float:
    """Return how well a brick suits metal, from 0 to 1; the manner says where metal lies."""
    strength, layer = _motif_of_cell(key, recipe, style, cell)
    chance = noise(key, _METAL_AT + cell)
    if manner < 0.35:  # in some layers
        fitness = noise(key, _LAYERS_AT + layer)
    elif manner < 0.55:  # in the middle of each layer
        fitness = strength
    elif manner < 0.7:  # in heaps at the bottom: a whole row of gold is no fun
        row, column = cell // COLUMNS, cell % COLUMNS
        fitness = 0.7 * row / recipe.rows + 0.3 * zigzag((column + 1.0) / 4.0)
    elif manner < 0.85:  # in columns
        fitness = zigzag((cell % COLUMNS + 1.0) * (1.0 + int(6.0 * style[5])) / 12.0)
    else:  # anywhere
        fitness = chance
    return 0.9 * fitness + 0.1 * chance


@kernel
def _colour_bricks(cells: Kinds, key: np.uint64, recipe: Recipe, bricks: int) -> None:
    """Turn the most suitable bricks into gold, the next ones into silver; colour the others."""
    golden = 0
    gold_from = _threshold_for(cells, recipe, int(recipe.gold * bricks), False)
    for cell in range(cells.shape[0]):
        if cells[cell] >= gold_from:
            cells[cell] = _GOLDEN
            golden += 1
    silver_from = _threshold_for(cells, recipe, golden + int(recipe.silver * bricks), False)
    style = _style(key)
    for cell in range(cells.shape[0]):
        if cells[cell] == EMPTY:
            continue
        if cells[cell] == _GOLDEN:
            cells[cell] = GOLD
        elif cells[cell] >= silver_from:
            cells[cell] = SILVER
        else:
            cells[cell] = _colour(key, recipe, style, cell)


@kernel
def _colour(key: np.uint64, recipe: Recipe, style: tuple[float, ...], cell: int) -> int:
    """Return the colour of a brick's layer; in some levels it changes along or across the layer."""
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
def _recolour(cells: Kinds, key: np.uint64, recipe: Recipe, cell: int) -> None:
    """Turn a golden brick and its copies into coloured bricks."""
    style = _style(key)
    first = original(recipe.symmetry, recipe.rows, cell)
    for copy in range(cells.shape[0]):
        if original(recipe.symmetry, recipe.rows, copy) == first:
            cells[copy] = _colour(key, recipe, style, copy)


@kernel
def _open_gold(kinds: Kinds, cells: Kinds, key: np.uint64, recipe: Recipe) -> None:
    """Colour golden bricks, each with its copies, until a ball can come to every brick."""
    search_reachable(kinds)
    for _ in range(cells.shape[0]):  # each round colours a cell
        if count_unreached(kinds) == 0:
            break
        _recolour(cells, key, recipe, _gold_to_open(kinds, cells, key, recipe))
        search_reachable(kinds)
    clear_search(kinds)


@kernel
def _gold_to_open(kinds: Kinds, cells: Kinds, key: np.uint64, recipe: Recipe) -> int:
    """Return a golden cell at the edge of what is reached, if possible with a brick behind it."""
    first = _rows_above(key) * COLUMNS
    best, found = -1.0, -1
    for cell in range(cells.shape[0]):
        if cells[cell] == GOLD and borders_reached(kinds, first + cell):
            fitness = noise(key, _GRAIN_AT + original(recipe.symmetry, recipe.rows, cell))
            if _borders_cut_off_brick(kinds, first + cell):
                fitness += 1.0
            if fitness > best:
                best, found = fitness, cell
    return found


@kernel
def _borders_cut_off_brick(kinds: Kinds, cell: int) -> bool:
    """Return whether a breakable brick beside a cell is out of reach."""
    column = cell % COLUMNS
    return bool(
        (cell >= COLUMNS and _is_cut_off(kinds[cell - COLUMNS]))
        or (cell < CELLS - COLUMNS and _is_cut_off(kinds[cell + COLUMNS]))
        or (column > 0 and _is_cut_off(kinds[cell - 1]))
        or (column < COLUMNS - 1 and _is_cut_off(kinds[cell + 1]))
    )


@kernel
def _is_cut_off(kind: int) -> bool:
    """Return whether a cell of a searched level holds a breakable brick out of reach."""
    return EMPTY < kind < GOLD
