// Levels on the drawing board: the generator and the search for bricks are kernels.

/** Return the kinds of bricks that letters stand for, one for each cell. */
export function kindsOf(bricks, { BRICK_LETTERS, CELLS }) {
  const kinds = new Uint8Array(CELLS);
  const letters = bricks.replace(/\s/g, "");
  if (letters.length > CELLS) throw new RangeError(`a level has ${CELLS} cells at most`);
  Array.from(letters).forEach((letter, cell) => {
    const kind = BRICK_LETTERS.indexOf(letter);
    if (kind < 0) throw new RangeError(`${letter} is no brick: ${BRICK_LETTERS} are`);
    kinds[cell] = kind;
  });
  return kinds;
}

/** A level on the drawing board. */
export class Board {
  constructor(machine) {
    this.machine = machine;
    this.record = machine.record("Board");
  }

  /** The letters of the bricks, one for each cell, row by row from the top. */
  get bricks() {
    const { BRICK_LETTERS } = this.machine.manifest.rules;
    return Array.from(this.record.kind, (kind) => BRICK_LETTERS[kind]).join("");
  }

  set bricks(bricks) {
    this.record.kind = kindsOf(bricks, this.machine.manifest.rules);
  }

  /**
   * Lay the level that the generator makes of a seed and a difficulty.
   * @param {object} recipe what shall be otherwise: motif and symmetry (words of the manifest's
   *   `generator`), rows, density, silver, gold
   * @returns {string} the bricks
   */
  generate(seed, difficulty = 0.5, recipe = {}) {
    const { motifs, symmetries } = this.machine.manifest.generator;
    const numbers = { ...recipe };
    if ("motif" in recipe) numbers.motif = motifs.indexOf(recipe.motif);
    if ("symmetry" in recipe) numbers.symmetry = symmetries.indexOf(recipe.symmetry);
    Object.assign(this.record, { seed, difficulty });
    this.machine.kernels.plan(0, this.record.$address);
    Object.assign(this.record, numbers);
    this.machine.kernels.lay(0, this.record.$address);
    return this.bricks;
  }

  /**
   * Find the bricks that no ball can reach.
   * @returns {{breakable: number, unreachable: number[]}} how many bricks can be broken; and the
   *   cells of those that can't be reached
   */
  search() {
    this.machine.kernels.search(0, this.record.$address);
    const cells = Array.from(this.record.blocked, (blocked, cell) => (blocked ? cell : -1));
    return { breakable: this.record.breakable, unreachable: cells.filter((cell) => cell >= 0) };
  }
}
