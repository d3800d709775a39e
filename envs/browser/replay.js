// Replays: files of recorded games, written and read as `envs/batch/replays.py` does, and played
// again with their checksums compared.

const MARK = "ARKAPLAY";
const FORMAT = 1;
const HEADER = 22; // bytes: mark, format (2), checksum (4), length (8)
const MOST_TEXT = 1 << 24; // bytes of JSON
const MOST_DECISIONS = 10_000_000;
const MOST_COLOURS = 256; // of the palette of commands
// Integers that may need more digits than a number of JavaScript has. They are read as text.
const WIDE = /"(random|start_seed)":\s*(\d+)/g;

/** A recorded game. */
export class Replay {
  /**
   * @param {object} head what the file's JSON holds; `start.random` is a BigInt
   * @param {Float64Array} commands velocity and fire of each decision, one after the other
   */
  constructor(head, commands) {
    this.version = head.version;
    this.config = head.config;
    this.levels = head.levels;
    this.start = head.start;
    this.result = head.result;
    this.checksums = head.checksums;
    this.commands = commands;
  }

  /** How many decisions it has. */
  get length() {
    return this.commands.length / 2;
  }

  /**
   * Find the game that can play it.
   * @param {object} manifest
   * @returns {string | undefined} its name
   */
  gameOf(manifest) {
    // Keywords that are younger than the replay have their defaults.
    const config = withoutLevels({ ...manifest.defaults, ...this.config });
    const wanted = canonical([config, this.levels]);
    return Object.keys(manifest.games).find((name) => {
      const { of_the_game: found, levels } = manifest.games[name];
      return canonical([withoutLevels(found), levels]) === wanted;
    });
  }

  /**
   * Open the game that can play it.
   * @param {Arkanoid} arkanoid
   * @returns {Promise<Game>} one of the manifest's games, which can be observed, if one fits
   * @throws {RangeError} its configuration is none of the game
   */
  async open(arkanoid) {
    const name = this.gameOf(arkanoid.manifest);
    if (name) return arkanoid.open(name);
    return arkanoid.openAs({ ...arkanoid.manifest.defaults, ...this.config }, this.levels);
  }

  /**
   * Play it again, and compare its checksums.
   * @param {Game} game that `open` returned
   * @yields {number} how many decisions are played: 0 at first
   * @throws {Error} the game takes another course
   */
  *play(game) {
    const { every, noted } = game.machine.manifest.checksums;
    game.resetAs(this.start);
    game.record.checksum = 0;
    let last = game.note();
    const compare = (place) => {
      if (this.checksums[place] !== last) {
        throw new Error(`the game takes another course before decision ${place * noted}`);
      }
    };
    compare(0);
    yield 0;
    let reward = 0;
    for (let played = 1; played <= this.length; played++) {
      if (game.over) throw new Error(`the game is over after ${played - 1} decisions`);
      game.step([this.commands[2 * played - 2], this.commands[2 * played - 1]]);
      reward += game.outcome.reward;
      if (!game.over && played % every === 0) last = game.note();
      if (!game.over && played % noted === 0) compare(played / noted);
      yield played;
    }
    compare(this.checksums.length - 1);
    const found = canonical(resultOf(game, this.length, reward));
    if (found !== canonical(this.result)) throw new Error("the game ends differently");
  }

  /**
   * @param {Game} tools any game: its machine computes the file's checksum
   * @returns {Promise<Uint8Array>} the file
   */
  async toBytes(tools) {
    const { rules } = tools.machine.manifest;
    const [palette, packed] = packCommands(this.commands);
    const { version, config, levels, start, result, checksums } = this;
    const head = { version, rules: rules.RULES_VERSION, config, levels, start, result, checksums };
    const text = JSON.stringify({ ...head, palette }, (key, value) =>
      typeof value === "bigint" ? `${value}n` : value,
    ).replace(/"(\d+)n"/g, "$1");
    const json = await compress(new TextEncoder().encode(text));
    const length = new Uint8Array(4);
    new DataView(length.buffer).setUint32(0, json.length, true);
    const content = await joined([length, json, await compress(packed)]);
    const header = new Uint8Array(HEADER);
    header.set(new TextEncoder().encode(MARK));
    const view = new DataView(header.buffer);
    view.setUint16(8, FORMAT, true);
    view.setUint32(10, checksumOf(tools.machine, content), true);
    view.setBigUint64(14, BigInt(content.length), true);
    return joined([header, content]);
  }

  /**
   * @param {Uint8Array} file
   * @param {Game} tools any game
   * @returns {Promise<Replay>}
   * @throws {Error} it is no replay, damaged, or of another version of the rules
   */
  static async fromBytes(file, tools) {
    const view = new DataView(file.buffer, file.byteOffset, file.length);
    const mark = new TextDecoder().decode(file.subarray(0, MARK.length));
    if (file.length < HEADER || mark !== MARK) throw new Error("this is no replay");
    if (view.getUint16(8, true) !== FORMAT) throw new Error("the replay is of another format");
    const content = file.subarray(HEADER);
    const whole = BigInt(content.length) === view.getBigUint64(14, true);
    if (!whole || checksumOf(tools.machine, content) !== view.getUint32(10, true)) {
      throw new Error("the replay is damaged");
    }
    const length = view.getUint32(HEADER, true);
    const text = new TextDecoder().decode(await expand(content.subarray(4, 4 + length), MOST_TEXT));
    const head = JSON.parse(text.replace(WIDE, '"$1":"$2"'));
    const { rules } = tools.machine.manifest;
    if (!Number.isInteger(head.rules)) throw new Error("the replay is damaged");
    if (head.rules !== rules.RULES_VERSION) {
      throw new Error(`the replay is of version ${head.rules} of the rules`);
    }
    head.start.random = BigInt(head.start.random);
    head.start.fields.start_seed = BigInt(head.start.fields.start_seed);
    const { decisions } = head.result;
    if (!(decisions >= 0 && decisions <= MOST_DECISIONS)) throw new Error("the replay is damaged");
    const size = decisions * (head.palette === null ? 16 : 1);
    const packed = await expand(content.subarray(4 + length), size);
    if (packed.length !== size) throw new Error("the replay is damaged");
    return new Replay(head, unpackCommands(head.palette, packed));
  }
}

/** Records the games of a player, each from its beginning. */
export class Recorder {
  /** @param {Game} game whose `reset` and `step` are called through this from now on */
  constructor(game) {
    this.game = game;
    this._begun = false;
  }

  /** Begin a game, see `Game.reset`. */
  reset(options) {
    this.game.reset(options);
    const { world, machine } = this.game;
    this._begun = true;
    this._commands = [];
    this._reward = 0;
    this._checksums = [];
    const { BRICK_LETTERS } = machine.manifest.rules;
    const letters = Array.from(world.start_kind, (kind) => BRICK_LETTERS[kind]).join("");
    const names = ["start", "start_round", "start_difficulty", "start_boss"];
    const fields = Object.fromEntries(names.map((name) => [name, world[name]]));
    fields.start_seed = machine.view.getBigInt64(this._place("start_seed"), true);
    const layout = letters.slice(0, letters.search(/\.*$/));
    this._start = { random: world.first_random, fields, layout };
    this.game.record.checksum = 0;
    this._checksums.push((this._checksum = this.game.note()));
  }

  /** Play a decision, see `Game.step`. */
  step(action) {
    const { game } = this;
    if (!this._begun) throw new Error("a recording begins with a reset");
    if (game.over) return;
    // Zero has no sign: files would lose it.
    game.step(typeof action === "number" ? action : [action[0] + 0, action[1]]);
    const command = game.machine.array("f8", game.record.arrays.commands, 2);
    this._commands.push(command[0], command[1]);
    this._reward += game.outcome.reward;
    const { every, noted } = game.machine.manifest.checksums;
    const played = this._commands.length / 2;
    if (game.over || played % every !== 0) return;
    this._checksum = game.note();
    if (played % noted === 0) this._checksums.push(this._checksum);
  }

  /** @returns {Replay} the game so far */
  replay() {
    const { game } = this;
    const head = {
      version: game.machine.manifest.version,
      config: game.rules,
      levels: game.levels,
      start: this._start,
      result: resultOf(game, this._commands.length / 2, this._reward),
      checksums: [...this._checksums, this._checksum],
    };
    return new Replay(head, Float64Array.from(this._commands));
  }

  _place(name) {
    const { fields } = this.game.machine.manifest.records.World;
    return this.game.world.$address + fields[name].place;
  }
}

function resultOf(game, decisions, reward) {
  const { score, lives, round_number: round, terminated, truncation } = game.outcome;
  return { decisions, reward, score, lives, round, terminated: terminated !== 0, truncation };
}

/** Return JSON in which the order of keys does not matter. */
function canonical(value) {
  return JSON.stringify(value, (key, inner) => {
    if (inner === null || typeof inner !== "object" || Array.isArray(inner)) return inner;
    return Object.fromEntries(Object.entries(inner).sort());
  });
}

/** Levels count by their bricks, and not by what they were asked for with. */
function withoutLevels({ levels, ...config }) {
  return config;
}

function checksumOf(machine, bytes) {
  const { free } = machine;
  const block = machine.record("Block");
  block.address = machine.reserve(bytes.length);
  block.length = bytes.length;
  machine.bytes(block.address, bytes.length).set(bytes);
  block.checksum = 0;
  machine.kernels.add(0, block.$address);
  const { checksum } = block;
  machine.bytes(free, machine.free - free).fill(0);
  machine.free = free;
  return checksum;
}

function packCommands(commands) {
  const places = new Map();
  const packed = new Uint8Array(commands.length / 2);
  for (let index = 0; index < packed.length && places.size <= MOST_COLOURS; index++) {
    const key = `${commands[2 * index]} ${commands[2 * index + 1]}`;
    if (!places.has(key)) places.set(key, places.size);
    packed[index] = places.get(key);
  }
  if (places.size <= MOST_COLOURS) {
    return [Array.from(places.keys(), (key) => key.split(" ").map(Number)), packed];
  }
  const bytes = new Uint8Array(Float64Array.from(commands).buffer);
  return [null, bytes.map((_, place) => bytes[planePlace(place, packed.length)])];
}

function unpackCommands(palette, packed) {
  if (palette === null) {
    const bytes = new Uint8Array(packed.length);
    const decisions = packed.length / 16;
    packed.forEach((byte, place) => (bytes[planePlace(place, decisions)] = byte));
    return new Float64Array(bytes.buffer);
  }
  return Float64Array.from({ length: 2 * packed.length }, (_, place) =>
    palette[packed[place >> 1]][place & 1],
  );
}

/** Return where in the commands a byte lies, which is at a place of their sixteen planes. */
function planePlace(place, decisions) {
  return (place % decisions) * 16 + Math.floor(place / decisions);
}

async function joined(parts) {
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

async function compress(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new CompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function expand(bytes, most) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const parts = [];
  let length = 0;
  for (const reader = stream.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) return joined(parts);
    length += value.length;
    if (length > most) throw new Error("the replay is damaged");
    parts.push(value);
  }
}
