"""Levels on the drawing board: generated ones, and whether all of their bricks can be reached."""

from typing import Any

from ...physics.kernels import inlined, kernel
from ...physics.kernels.borrowed import BYTE
from ...physics.kernels.portable import array_at, on_stack
from ..levels.clearability import search_reachable
from ..levels.generator import Recipe, lay_recipe, make_recipe
from ..rules import CELLS, EMPTY, GOLD
from .records import Board

_KIND = int(Board.fields["kind"][1])  # type: ignore[index]


@kernel
def plan_board(board: Any) -> None:
    """Write the recipe of the board's seed and difficulty."""
    recipe = make_recipe(board.seed, board.difficulty)
    board.motif = recipe.motif
    board.rows = recipe.rows
    board.density = recipe.density
    board.symmetry = recipe.symmetry
    board.silver = recipe.silver
    board.gold = recipe.gold


@kernel
def lay_board(address: int, board: Any) -> None:
    """Write the level of the board's seed and recipe."""
    recipe = Recipe(
        board.motif, board.rows, board.density, board.symmetry, board.silver, board.gold
    )
    lay_recipe(array_at(address + _KIND, (CELLS,), BYTE), board.seed, recipe)


@inlined
def _is_breakable(kind: int) -> bool:
    return kind != EMPTY and kind < GOLD


@kernel
def search_board(board: Any) -> None:
    """Write which bricks of the board no ball can come to."""
    kinds = on_stack(CELLS)
    for cell in range(CELLS):
        kinds[cell] = board.kind[cell]
    search_reachable(kinds)
    board.breakable = 0
    board.unreachable = 0
    for cell in range(CELLS):
        # A cell that a ball can come to has a larger number now.
        blocked = _is_breakable(kinds[cell])
        board.blocked[cell] = 1 if blocked else 0
        board.unreachable += 1 if blocked else 0
        board.breakable += 1 if _is_breakable(board.kind[cell]) else 0
