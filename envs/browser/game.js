// The game in JavaScript: every rule, drawing and observation is a kernel of the module.

import { Board, kindsOf } from "./board.js";
import { Machine } from "./machine.js";
import { Meeting } from "./meeting.js";
import { Sandbox } from "./worlds.js";

/**
 * @typedef {object} Start how episodes begin from now on; nothing given changes nothing
 * @property {number | bigint} [seed] of the random numbers: forgets earlier options
 * @property {string | number} [level] the first round: a named level, or the number of a round
 * @property {string} [bricks] the first round: the letters of its cells, row by row from the top
 * @property {boolean} [boss] with bricks: whether the boss is there
 * @property {number | bigint} [levelSeed] the first round: the one that the generator makes
 * @property {boolean} [repeat] with levelSeed: whether all further rounds are this level, too
 * @property {number | null} [difficulty] of all generated levels; null: as the game says
 */

// How many sizes are kept. Drawing what does not change takes a hundred times as long as the rest.
const MOST_PICTURES = 8;

/**
 * Compile the module.
 * @param {BufferSource | WebAssembly.Module} code of the module
 * @param {object} manifest
 * @returns {Promise<Arkanoid>}
 */
export async function loadArkanoid(code, manifest) {
  const module = code instanceof WebAssembly.Module ? code : await WebAssembly.compile(code);
  return new Arkanoid(module, manifest);
}

/** The compiled module and its manifest. */
export class Arkanoid {
  constructor(module, manifest) {
    this.module = module;
    this.manifest = manifest;
  }

  /** @returns {Promise<Machine>} a machine of its own */
  async machine() {
    return new Machine(await WebAssembly.instantiate(this.module, {}), this.manifest);
  }

  /**
   * @param {string} name of one of the manifest's games
   * @returns {Promise<Game>} the game, which waits for `reset`
   */
  async open(name) {
    const image = this.manifest.games[name];
    if (!image) {
      throw new RangeError(`no game ${name}: there are ${Object.keys(this.manifest.games)}`);
    }
    return new Game(await this.machine(), name, image);
  }

  /**
   * Open a game with other rules and levels, such as a replay has. Nobody can observe it.
   * @param {object} config all keywords of the environment
   * @param {object} levels as `Replay.levels`
   * @returns {Promise<Game>}
   * @throws {RangeError} a keyword is too small or too large
   */
  async openAs(config, levels) {
    const [name] = Object.keys(this.manifest.games);
    const image = this.manifest.games[name];
    checkLimits(config, this.manifest.limits);
    const { length } = this.manifest.records.LevelEntry;
    const game = new Game(await this.machine(), "a game", {
      ...image,
      config,
      levels,
      of_the_game: config,
      commands: null,
      meanings: null,
      parts: {},
      shapes: {},
    });
    setRules(game, config, levels);
    game.record.paddle = config.paddle;
    game.machine.kernels.fit(0, game.record.$address);
    const table = game.machine.reserve(levels.bricks.length * length);
    levels.bricks.forEach((bricks, index) => {
      const entry = game.machine.record("LevelEntry", table + index * length);
      entry.kind = kindsOf(bricks, this.manifest.rules);
      entry.boss = Number(levels.boss[index]);
    });
    game.record.arrays.levels = table;
    game.record.arrays.num_levels = levels.bricks.length;
    return game;
  }

  /** @returns {Promise<Board>} an empty drawing board for a level */
  async board() {
    return new Board(await this.machine());
  }

  /** @returns {Promise<Meeting>} two bodies */
  async meeting() {
    return new Meeting(await this._scene());
  }

  /** @returns {Promise<Sandbox>} a world to throw things in */
  async sandbox() {
    return new Sandbox(await this._scene(), fromBase64(this.manifest.worlds.header));
  }

  /** Return a machine with the tables of shapes. */
  async _scene() {
    const machine = await this.machine();
    const { image, length } = this.manifest.meetings;
    machine.bytes(machine.reserve(length), length).set(fromBase64(image));
    return machine;
  }
}

/** Refuse numbers that `envs/config.py` refuses. Where there is no difficulty, it rises. */
function checkLimits(config, limits) {
  for (const [name, [least, most]] of Object.entries(limits)) {
    const value = name === "difficulty" ? config[name] ?? least : config[name];
    if (!(value >= least && value <= most)) {
      throw new RangeError(`${name} is ${config[name]}, and not from ${least} to ${most}`);
    }
  }
}

/** Write the numbers of the rules, as `envs/game/rulebook.py` does. */
function setRules(game, config, levels) {
  const { rules: given } = game.machine.manifest;
  const [first, end] = levels.seeds;
  Object.assign(game.machine.record("Rules", game.address("rules")), {
    ball_speed: given.BALL_SPEED * config.speed,
    frame_skip: config.frame_skip,
    sticky_action: config.sticky_action,
    auto_fire: Number(config.actions === "discrete3"),
    deflection: given.DEFLECTIONS[config.deflection],
    reward: given.REWARDS[config.reward],
    life_penalty: config.life_penalty,
    lives: config.lives,
    max_decisions: config.max_decisions,
    capsule_rate: config.capsules ? config.capsule_rate : 0,
    enemies: Number(config.enemies),
    first_seed: first,
    num_seeds: end - first,
    table_counts: Number(levels.names.length > 0),
    endless: Number(levels.endless),
    difficulty: config.difficulty ?? -1,
    first_difficulty: levels.first_difficulty,
  });
}

/** Decode base64, as the manifest holds bytes. */
export function fromBase64(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

/** A game with one world. */
export class Game {
  constructor(machine, name, image) {
    this.machine = machine;
    this.name = name;
    this.config = image.config;
    this.commands = image.commands; // velocity and fire of each action; null: actions are these
    this.meanings = image.meanings; // of each action
    this.levels = image.levels;
    this.rules = image.of_the_game; // the configuration, without what does not change the game
    this.parts = image.parts; // of observations: first and last place (exclusive) by name
    this.shapes = image.shapes; // of observations
    this._image = image;
    const start = machine.reserve(image.length);
    if (start !== machine.manifest.free) throw new Error("a game lies at the memory's beginning");
    const content = image.image instanceof Uint8Array ? image.image : fromBase64(image.image);
    machine.bytes(start, content.length).set(content);
    const at = image.addresses;
    this.record = machine.record("Game", at.game);
    this.world = machine.record("World", at.world);
    this.outcome = machine.record("Outcome", at.outcome);
    this._at = at.game;
    // What every step needs, so that it does not look for it.
    this._action = this.record.arrays.actions;
    this._count = this.commands?.length ?? 0;
    this._fresh = this._bytes("World", at.world).slice();
    this._run("forget");
    this._pictures = new Map(); // by size, the latest last
    this._blocks = []; // memory of earlier pictures: address and length
  }

  /**
   * Begin a game; or its next life, with episodic_life and without options.
   * @param {Start} options
   */
  reset(options = {}) {
    const { state } = this.machine.manifest;
    const { seed, ...others } = options;
    if (seed === undefined && this.world.random === 0n) {
      throw new Error("the first reset needs a seed");
    }
    const fields = this._start(others);
    if (seed !== undefined) {
      this._bytes("World", this._image.addresses.world).set(this._fresh);
      this._run("forget");
      this.record.seed = BigInt.asUintN(64, BigInt(seed));
      this._run("seed");
    }
    for (const [name, value] of Object.entries(fields)) this.world[name] = value;
    if (seed !== undefined || Object.keys(fields).length) this.world.done = state.GAME_OVER;
    this._run("reset");
  }

  /** Let the next game begin like a recorded one: see `Replay.start`. */
  resetAs(start) {
    this.world.random = start.random;
    for (const [name, value] of Object.entries(start.fields)) this.world[name] = value;
    this.world.start_kind = this._kinds(start.layout);
    this.world.done = this.machine.manifest.state.GAME_OVER;
    this._run("reset");
  }

  /**
   * Play a decision: `config.frame_skip` ticks. A game that is over stays as it is.
   * @param {number | [number, number]} action its number; or velocity in [-1, 1], and fire, which
   *   every game takes
   */
  step(action) {
    if (typeof action === "number") {
      if (!(Number.isInteger(action) && action >= 0 && action < this._count)) {
        throw new RangeError(`${this.name} has no action ${action}`);
      }
      this.machine.view.setUint32(this._action, action, true); // the upper half is always 0
      this.machine.kernels.step(0, this._at);
      return;
    }
    const [velocity, fire] = action;
    if (!(Number.isFinite(velocity) && Number.isFinite(Number(fire)))) {
      throw new RangeError(`velocity and fire must be numbers; got ${action}`);
    }
    this.record.velocity = [velocity, Number(fire)];
    this._run("steer");
  }

  /** Whether the episode is over. */
  get over() {
    return this.world.done !== 0;
  }

  /** What the environment's `info` says, by its keys. */
  get info() {
    const { infos } = this.machine.manifest;
    const keys = Object.entries(infos);
    return Object.fromEntries(keys.map(([key, { field }]) => [key, this.outcome[field]]));
  }

  /** @returns {Float32Array} the game as agents see it, in the order of `parts.vector` */
  vector() {
    this._check("vector");
    this._run("vector");
    const [length] = this.shapes.vector;
    return this.machine.array("f4", this._image.addresses.vector, length);
  }

  /** @returns {Float32Array} planes over the cells of the field, of `shapes.grid` */
  grid() {
    this._check("grid");
    this._run("grid");
    const length = this.shapes.grid.reduce((one, other) => one * other, 1);
    return this.machine.array("f4", this._image.addresses.grid, length);
  }

  /**
   * Draw the game. Only what has changed since the last picture of this size is drawn.
   * @param {number} width in pixels
   * @param {number} height in pixels
   * @param {1 | 3 | 4} channels brightness; red, green, blue; the same and opacity, for canvases
   * @returns {Uint8ClampedArray} row by row; it is of use until the next call
   */
  draw(width, height, channels = 4) {
    const key = `${width} ${height} ${channels}`;
    const picture = this._pictures.get(key) ?? this._picture(width, height, channels);
    this._pictures.delete(key);
    this._pictures.set(key, picture);
    const { $address, memory } = picture;
    this.machine.kernels.draw(0, $address);
    return new Uint8ClampedArray(this.machine.memory.buffer, memory, width * height * channels);
  }

  /** @returns {Uint8Array} the state */
  save() {
    const { world, outcome } = this._image.addresses;
    const parts = [this._bytes("World", world), this._bytes("Outcome", outcome)];
    const saved = new Uint8Array(parts[0].length + parts[1].length);
    saved.set(parts[0]);
    saved.set(parts[1], parts[0].length);
    return saved;
  }

  /** Go on from a state that this or the same game has saved. */
  restore(saved) {
    const { world, outcome } = this._image.addresses;
    const parts = [this._bytes("World", world), this._bytes("Outcome", outcome)];
    if (saved.length !== parts[0].length + parts[1].length) {
      throw new RangeError("these bytes are no state of a game");
    }
    parts[0].set(saved.subarray(0, parts[0].length));
    parts[1].set(saved.subarray(parts[0].length));
    this._run("forget");
  }

  /** @returns {number} where one of the image's things lies: "vector", say */
  address(name) {
    return this._image.addresses[name];
  }

  /** Take the state into the checksum of the states so far, and return it; see `replay.js`. */
  note() {
    this._run("note");
    return this.record.checksum;
  }

  _check(kind) {
    if (!this.shapes[kind]) throw new Error(`${this.name} can't be observed`);
  }

  _run(kernel) {
    this.machine.kernels[kernel](0, this._at);
  }

  _bytes(name, address) {
    return this.machine.bytes(address, this.machine.manifest.records[name].length);
  }

  _kinds(bricks) {
    return kindsOf(bricks, this.machine.manifest.rules);
  }

  /** Return the fields of `World` that options set, as `envs/levels/starts.py` does. */
  _start({ level, bricks, boss = false, levelSeed, repeat = false, difficulty }) {
    const { state, levels } = this.machine.manifest;
    const fields = {};
    const named = typeof level === "string" ? this.levels.names.indexOf(level) : -1;
    if (typeof level === "number" || named >= 0) {
      fields.start = state.AS_CONFIGURED;
      fields.start_round = named >= 0 ? named + 1 : level;
    } else if (level !== undefined) {
      const found = levels.find(({ name }) => name === level);
      if (!found) throw new RangeError(`no level ${level}`);
      ({ bricks, boss } = found);
    }
    if (bricks !== undefined) {
      if (boss && !this.config.enemies) throw new RangeError(`${this.name} has no boss`);
      fields.start = state.GIVEN_LAYOUT;
      fields.start_round = 1;
      fields.start_kind = this._kinds(bricks);
      fields.start_boss = Number(boss);
    } else if (levelSeed !== undefined) {
      fields.start = repeat ? state.REPEATED_SEED : state.GIVEN_SEED;
      fields.start_round = 1;
      fields.start_seed = levelSeed;
      fields.start_boss = 0;
    }
    if (difficulty !== undefined) {
      fields.start_difficulty = difficulty ?? this.machine.manifest.start.start_difficulty;
    }
    return fields;
  }

  /** Return a new picture, in place of the one that was not drawn for the longest time. */
  _picture(width, height, channels) {
    const { machine } = this;
    let picture;
    if (this._pictures.size < MOST_PICTURES) {
      picture = machine.record("Picture");
    } else {
      const [[oldest, record]] = this._pictures;
      this._pictures.delete(oldest);
      picture = record;
      this._blocks.push(picture.block);
    }
    const pattern = machine.bytes(this.address("picture"), machine.manifest.records.Picture.length);
    machine.bytes(picture.$address, pattern.length).set(pattern);
    Object.assign(picture, { width, height, channels });
    machine.kernels.measure(0, picture.$address);
    picture.block = this._block(picture.length);
    picture.memory = picture.block.address;
    machine.kernels.begin(0, picture.$address);
    return picture;
  }

  /** Return memory of a length or more: what an earlier picture had, or new memory. */
  _block(needed) {
    const fits = this._blocks.findIndex(({ length }) => length >= needed);
    if (fits >= 0) return this._blocks.splice(fits, 1)[0];
    // A page that grows soon needs more.
    const length = Math.ceil(1.5 * needed);
    return { address: this.machine.reserve(length), length };
  }
}
