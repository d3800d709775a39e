// The editor: a level is painted brick by brick; the kernels draw it, and say if it can be cleared.

import { download, make, picks } from "arkanoid/data";
import { randomSeed } from "arkanoid/levels";
import { levelText, parseLevel } from "arkanoid/levelfile";
import { Trials } from "arkanoid/trials";

const PLACE = "arkanoid.level";
const TRIES = 20;
const MOST_UNDONE = 500;
const MOST_BYTES = 1 << 20; // of a level file
const KEYS = {
  ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down", " ": "paint",
  "Ctrl+z": "undo", "Ctrl+y": "redo", "Ctrl+Shift+z": "redo",
};
const WAYS = { left: [0, -1], right: [0, 1], up: [-1, 0], down: [1, 0] };

export class Editor {
  /** @param {object} app what all pages share, see `app.js` */
  constructor(app) {
    this.app = app;
    this.phase = "editing";
    const { manifest } = app.arkanoid;
    this._rules = manifest.rules;
    this.keys = { ...KEYS };
    for (const letter of this._rules.BRICK_LETTERS) {
      this.keys[letter.toLowerCase()] = `brush ${letter}`;
    }
    this._find = (id) => document.getElementById(id);
    this._undone = [];
    this._done = [];
    this._cell = null; // under the mouse or the cursor
    this._brush = "r";
    for (const button of app.panel("editor").querySelectorAll("[data-edit]")) {
      button.onclick = () => this[button.dataset.edit]();
    }
    this._find("boss").onchange = () => this._show();
    const [agent] = app.facts.agents;
    this._trials = new Trials(app.arkanoid, agent, (name) => app.network(name));
    this._find("who").textContent = agent.name;
    this._fillPalette(app.facts.bricks);
    this._fillRecipe(manifest.generator);
    picks(this._find("level-file"), (file) => this.dropped(file));
  }

  get runs() {
    return false;
  }

  /** Nobody steers a paddle here. */
  get steers() {
    return null;
  }

  get deed() {
    return null;
  }

  async enter() {
    if (this.game) return;
    this._board = await this.app.arkanoid.board();
    const game = await this.app.arkanoid.open("full by hand");
    this._level = this._remembered() ?? parseLevel("", this._rules);
    game.reset({ seed: 0 });
    this.game = game;
    if (/^\.*$/.test(this._level.bricks)) this._level.bricks = this._board.generate(1, 0.5);
    this._take(this._level);
  }

  leave() {
    this._stroking = false;
    this._trials.stop();
    this._find("tries").hidden = true;
  }

  /** Whether nothing moves. */
  get still() {
    return true;
  }

  press(key) {
    if (key in WAYS) this._move(...WAYS[key]);
    else if (key.startsWith("brush ")) this._choose(key.at(-1));
    else if (key === "undo" || key === "redo") this[key]();
    else if (key === "paint") this._stroke(() => this._paint([this._cell]));
  }

  release(key) {
    if (key !== "fire") return;
    this._stroking = false;
    this._place = null;
  }

  /** Follow the pointer, and paint while it is held. */
  point(x, y, held) {
    const cells = this._cellsTo(x, y, held);
    this._cell = cells.at(-1);
    this.app.stage.stale = true;
    if (!held) this._stroking = false;
    else if (this._stroking) this._paint(cells);
    else this._stroking = this._stroke(() => this._paint(cells));
  }

  /** @returns {Array<number | null>} the cells from the last place of a stroke to this one */
  _cellsTo(x, y, held) {
    const { LATTICE_TOP, BRICK_HEIGHT, BRICK_WIDTH, COLUMNS, ROWS } = this._rules;
    const place = [x / BRICK_WIDTH, (LATTICE_TOP - y) / BRICK_HEIGHT];
    const before = (held && this._place) || place;
    this._place = held ? place : null;
    // A fast pointer passes several cells from one event to the next.
    const ways = place.map((end, axis) => end - before[axis]);
    const steps = Math.ceil(2 * Math.max(...ways.map(Math.abs)));
    return Array.from({ length: steps + 1 }, (_, step) => {
      const part = steps ? step / steps : 1;
      const [column, row] = ways.map((way, axis) => Math.floor(before[axis] + part * way));
      const inside = row >= 0 && row < ROWS && column >= 0 && column < COLUMNS;
      return inside ? row * COLUMNS + column : null;
    });
  }

  tick() {
    return false;
  }

  notice() {
    return {};
  }

  painted() {
    const pen = this.app.stage.sheet();
    for (const cell of this._barred) this._cross(pen, cell);
    if (this._cell !== null) this._frame(pen, this._cell);
  }

  undo() {
    this._swap(this._done, this._undone);
  }

  redo() {
    this._swap(this._undone, this._done);
  }

  clear() {
    this._stroke(() => this._set(".".repeat(this._rules.CELLS)));
  }

  play() {
    const { bricks, boss } = this._level;
    this.app.playLevel({ bricks, boss });
  }

  /** Let the agent play this level. */
  async attempt() {
    const { bricks, boss } = this._level;
    const shown = this._find("tries");
    shown.hidden = false;
    shown.textContent = "Trying …";
    const tried = await this._trials.run({ bricks, boss }, TRIES, ({ played, cleared, ticks }) => {
      const seconds = Math.round(ticks / cleared / this._rules.TICKS_PER_SECOND);
      const took = cleared ? `, in ${seconds} s on average` : "";
      shown.textContent = `Cleared ${cleared} of ${played}${took}.`;
    });
    if (!tried) shown.textContent = this.app.following.news.agent;
  }

  another() {
    this._find("number").value = randomSeed() % 10_000;
    this._generate();
  }

  save() {
    const text = levelText(this._level, this._rules);
    const name = this._level.name.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "_") || "level";
    download(text, `${name}.txt`);
  }

  open() {
    this._find("level-file").click();
  }

  /** Take a level file. */
  async dropped(file) {
    const fault = this._find("level-fault");
    try {
      if (file.size > MOST_BYTES) throw new Error("This is no level: the file is too large.");
      const level = parseLevel(await file.text(), this._rules, file.name.replace(/\.[^.]*$/, ""));
      this._stroke(() => this._take(level));
      fault.textContent = "";
    } catch (error) {
      fault.textContent = error.message;
      fault.closest("details").open = true;
    }
  }

  _take(level) {
    this._level = { ...level };
    this._find("level-name").value = level.name;
    this._find("boss").checked = level.boss;
    this._show();
  }

  /** Do something that can be undone. @returns {boolean} whether it changed the bricks */
  _stroke(change) {
    const { bricks } = this._level;
    change();
    if (this._level.bricks === bricks) return false;
    this._done.push(bricks);
    if (this._done.length > MOST_UNDONE) this._done.shift();
    this._undone = [];
    this._show();
    return true;
  }

  _swap(from, to) {
    if (!from.length) return;
    to.push(this._level.bricks);
    this._set(from.pop());
  }

  _paint(cells) {
    const { COLUMNS } = this._rules;
    const letters = Array.from(this._level.bricks);
    for (const cell of cells) {
      if (cell === null) continue;
      letters[cell] = this._brush;
      const column = cell % COLUMNS;
      if (this._find("mirrored").checked) letters[cell - 2 * column + COLUMNS - 1] = this._brush;
    }
    this._set(letters.join(""));
  }

  _set(bricks) {
    if (bricks === this._level.bricks) return;
    this._level.bricks = bricks;
    this._show();
  }

  /** Move the cursor. */
  _move(down, right) {
    const { COLUMNS, ROWS } = this._rules;
    const cell = this._cell ?? Math.floor(COLUMNS / 2) - right - down * COLUMNS;
    const row = (Math.floor(cell / COLUMNS) + down + ROWS) % ROWS;
    const column = ((cell % COLUMNS) + right + COLUMNS) % COLUMNS;
    this._cell = row * COLUMNS + column;
    const here = this._level.bricks[this._cell];
    const brick = this.app.facts.bricks.find(({ letter }) => letter === here);
    this.app.say(`Row ${row + 1}, column ${column + 1}: ${brick?.name ?? "empty"}`);
    this.app.stage.stale = true;
  }

  _choose(letter) {
    this._brush = letter;
    this._find("palette").querySelector(`[value="${letter}"]`).checked = true;
  }

  /** Show the level as it is, and whether it can be cleared. */
  _show() {
    this._level.boss = this._find("boss").checked;
    const { bricks, boss } = this._level;
    this.game.reset({ seed: 0, bricks, boss });
    this._board.bricks = bricks;
    const { breakable, unreachable } = this._board.search();
    this._barred = unreachable;
    const good = !unreachable.length && (breakable > 0 || boss);
    const verdict = this._find("clearable");
    verdict.className = good ? "verdict good" : "verdict bad";
    verdict.textContent = verdictOf(breakable, unreachable.length, boss);
    const panel = this.app.panel("editor");
    panel.querySelector("[data-edit=play]").disabled = !good;
    const known = !boss || this._trials.knowsBoss;
    panel.querySelector("[data-edit=attempt]").disabled = !(good && known);
    panel.querySelector("[data-edit=undo]").disabled = !this._done.length;
    panel.querySelector("[data-edit=redo]").disabled = !this._undone.length;
    this._trials.stop();
    this._find("tries").hidden = true;
    this._remember();
    this.app.stage.stale = true;
  }

  _frame(pen, cell) {
    const [x, y, width, height] = this._area(cell);
    pen.lineWidth = 0.07;
    pen.strokeStyle = "#fff";
    pen.strokeRect(x, y, width, height);
  }

  _cross(pen, cell) {
    const [x, y, width, height] = this._area(cell);
    pen.lineCap = "round";
    for (const [colour, thick] of [["#000", 0.17], ["#ff5c5c", 0.09]]) {
      pen.strokeStyle = colour;
      pen.lineWidth = thick;
      pen.beginPath();
      pen.moveTo(x + 0.2, y + 0.12);
      pen.lineTo(x + width - 0.2, y + height - 0.12);
      pen.moveTo(x + width - 0.2, y + 0.12);
      pen.lineTo(x + 0.2, y + height - 0.12);
      pen.stroke();
    }
  }

  /** @returns {number[]} left, top, width and height of a cell in the picture, in brick widths */
  _area(cell) {
    const { view } = this.app.arkanoid.manifest;
    const { BRICK_HEIGHT, BRICK_WIDTH, COLUMNS, LATTICE_TOP } = this._rules;
    const top = view.height - LATTICE_TOP + Math.floor(cell / COLUMNS) * BRICK_HEIGHT;
    return [view.wall + (cell % COLUMNS) * BRICK_WIDTH, top, BRICK_WIDTH, BRICK_HEIGHT];
  }

  _generate() {
    const recipe = {};
    for (const id of ["motif", "symmetry"]) {
      if (this._find(id).value) recipe[id] = this._find(id).value;
    }
    const seed = Math.max(0, Math.trunc(Number(this._find("number").value)) || 0);
    const bricks = this._board.generate(seed, Number(this._find("hardness").value), recipe);
    this._stroke(() => this._set(bricks));
  }

  _fillPalette(bricks) {
    const empty = { letter: ".", name: "empty" };
    const choices = [...bricks, empty].map(({ letter, name, picture, width }) => {
      const input = make("input", { type: "radio", name: "brush", value: letter });
      input.checked = letter === this._brush;
      input.setAttribute("aria-label", name);
      input.onchange = () => (this._brush = letter);
      const image = picture
        ? make("img", { src: `data:image/png;base64,${picture}`, alt: "", width })
        : make("span", { className: "eraser" });
      return make("label", { title: `${name} ( ${letter} )` }, input, image);
    });
    this._find("palette").append(...choices);
  }

  _fillRecipe({ motifs, symmetries }) {
    for (const [id, words] of [["motif", motifs], ["symmetry", symmetries]]) {
      const any = make("option", { value: "" }, "Any");
      const options = words.map((word) => {
        return make("option", { value: word }, word.replaceAll("_", " "));
      });
      this._find(id).append(any, ...options);
    }
    const hardness = this._find("hardness");
    hardness.oninput = () => (this._find("hard").value = hardness.value);
    this._find("recipe").onsubmit = (event) => {
      event.preventDefault();
      this._generate();
    };
    this._find("level-name").oninput = () => {
      this._level.name = this._find("level-name").value;
      this._remember();
    };
  }

  _remember() {
    try {
      localStorage.setItem(PLACE, levelText(this._level, this._rules));
    } catch {
      // It is full, or forbidden.
    }
  }

  _remembered() {
    try {
      const text = localStorage.getItem(PLACE);
      return text ? parseLevel(text, this._rules) : null;
    } catch {
      return null;
    }
  }
}

function verdictOf(breakable, barred, boss) {
  if (barred) {
    const [count, verb] = barred === 1 ? ["1 brick", "is"] : [`${barred} bricks`, "are"];
    return `Nobody can clear it: ${count} behind gold ${verb} out of reach, crossed out.`;
  }
  if (!breakable && !boss) return "There is nothing to break yet.";
  const bricks = breakable === 1 ? "1 brick" : `${breakable} bricks`;
  return `It can be cleared: ${bricks}${boss ? " and the boss" : ""}, and all can be reached.`;
}
