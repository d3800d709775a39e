// Levels: how they are called, and the form that asks where a game begins.

import { make } from "arkanoid/data";

const MOST_SEED = 999_999_999; // of those that people type

/** @returns {number} a seed for a game's random numbers */
export function randomSeed() {
  const [high, low] = crypto.getRandomValues(new Uint32Array(2));
  return (high & 0x1fffff) * 2 ** 32 + low;
}

/** @returns {string} the title of the round that is played; without one, its number */
export function roundTitle({ world, machine }) {
  const { levels, rules } = machine.manifest;
  const letters = Array.from(world.kind, (kind) => rules.BRICK_LETTERS[kind]).join("");
  const found = levels.find(({ bricks }) => bricks === letters);
  return found ? found.title : `Round ${world.round_number}`;
}

/** The form that asks where a game begins. */
export class StartForm {
  /**
   * @param {HTMLFormElement} form which is filled
   * @param {object} manifest
   * @param {string} legend what is chosen first
   * @param {Array<{name: string, title: string, hint: string, game: string}>} choices
   * @param {() => void} changed
   */
  constructor(form, manifest, legend, choices, changed) {
    this._manifest = manifest;
    this._choices = choices;
    this._changed = changed;
    this._form = form;
    this._turn = 0; // of levels that are played in turn
    const id = form.dataset.start;
    this._hint = make("p", { className: "hint" });
    this._level = make("select", { id: `${id}-level` });
    this._seed = make("input", {
      type: "number", id: `${id}-seed`, min: 0, max: MOST_SEED, value: 7,
    });
    this._difficulty = make("input", {
      type: "range", id: `${id}-difficulty`, min: 0, max: 1, step: 0.05, value: 0.5,
    });
    this._shown = make("output", {}, "0.5");
    const dice = make("button", { type: "button" }, "Any");
    dice.onclick = () => {
      this._seed.value = randomSeed() % 10_000;
      this._change();
    };
    this._generated = make("div", { className: "generated" },
      make("label", { htmlFor: this._seed.id }, "Its number"),
      make("div", { className: "seed" }, this._seed, dice),
      make("label", { htmlFor: this._difficulty.id, className: "slider" },
        "Difficulty", this._shown),
      this._difficulty);
    form.append(
      make("fieldset", {}, make("legend", {}, legend), this._radios(id), this._hint),
      make("div", {}, make("label", { htmlFor: this._level.id }, "Level"), this._level),
      this._generated);
    form.addEventListener("change", () => this._change());
    this._difficulty.addEventListener("input", () => (this._shown.value = this._difficulty.value));
    this._fill();
  }

  /** The choice. */
  get choice() {
    const chosen = this._form.querySelector("input[type=radio]:checked").value;
    return this._choices.find(({ name }) => name === chosen);
  }

  /** What is chosen and typed, for later. */
  get state() {
    const { choice: { name }, _level: level, _seed: seed, _difficulty: difficulty } = this;
    return { name, own: this._own, values: [level, seed, difficulty].map(({ value }) => value) };
  }

  set state({ name, own, values }) {
    this._form.querySelector(`input[value="${name}"]`).checked = true;
    this._own = own;
    this._fill();
    [this._level.value, this._seed.value, this._difficulty.value] = values;
    this._fill(false);
  }

  /** @returns {object} how the game begins, for `Game.reset`, without a seed */
  get options() {
    const { value } = this._level;
    if (value === "own") {
      const { enemies } = this._manifest.games[this.choice.game].config;
      return { bricks: this._own.bricks, boss: this._own.boss && enemies };
    }
    if (value === "asked") return this._next();
    if (value !== "generated") return value === "1" ? {} : { level: Number(value) };
    const typed = Math.trunc(Number(this._seed.value));
    const levelSeed = Math.min(MOST_SEED, Math.max(0, typed || 0));
    return { levelSeed, repeat: true, difficulty: Number(this._difficulty.value) };
  }

  /** Offer a level of the editor, and choose it. */
  offer(level) {
    this._own = level;
    this._fill();
    this._level.value = "own";
    this._fill(false);
  }

  /**
   * Offer levels that are played in turn, and choose them.
   * @param {{title: string, starts: object[]}} levels
   */
  ask(levels) {
    this._asked = levels;
    this._fill();
    this._level.value = "asked";
    this._fill(false);
  }

  /** Go on to the next level, where levels are played in turn. */
  turn() {
    this._turn += 1;
  }

  /** Choose the round after another one. */
  chooseRound(number) {
    this._level.value = String(number);
    if (this._level.selectedIndex < 0) {
      this._level.append(make("option", { value: String(number) }, `Round ${number}`));
      this._level.value = String(number);
    }
    this._fill(false);
  }

  _next() {
    const { starts } = this._asked;
    const start = starts[this._turn % starts.length];
    const { enemies } = this._manifest.games[this.choice.game].config;
    return start.boss ? { ...start, boss: enemies } : start;
  }

  _radios(id) {
    const group = make("div", { className: "choice" });
    this._choices.forEach(({ name, title }, index) => {
      const input = make("input", { type: "radio", name: `${id}-choice`, value: name });
      input.checked = index === 0;
      group.append(make("label", {}, input, make("span", {}, title)));
    });
    return group;
  }

  _change() {
    this._fill();
    this._changed();
  }

  /** Show what the choice offers. */
  _fill(levels = true) {
    const { game, hint } = this.choice;
    this._hint.textContent = hint;
    if (levels) this._fillLevels(this._manifest.games[game].levels.names);
    this._generated.hidden = this._level.value !== "generated";
    this._shown.value = this._difficulty.value;
  }

  _fillLevels(names) {
    const before = this._level.value;
    const titles = new Map(this._manifest.levels.map(({ name, title }) => [name, title]));
    const rounds = names.map((name, index) => {
      const number = String(index + 1);
      return make("option", { value: number }, `${number} · ${titles.get(name) ?? name}`);
    });
    if (!names.length) rounds.push(make("option", { value: "1" }, "As in the training"));
    const group = make("optgroup", { label: "The rounds" }, ...rounds);
    const generated = make("option", { value: "generated" }, "A generated level");
    const first = [];
    if (this._own) first.push(make("option", { value: "own" }, "Your level"));
    if (this._asked) first.push(make("option", { value: "asked" }, this._asked.title));
    this._level.replaceChildren(...first, group, generated);
    if (before) this._level.value = before;
    if (this._level.selectedIndex < 0) this._level.selectedIndex = 0;
  }
}
