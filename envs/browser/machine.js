// A module of the game's kernels with its memory, and records in it whose fields have names.

/**
 * What NumPy calls a type, and what JavaScript calls it: the word in the names of `DataView`'s
 * methods, and the class of arrays.
 */
const TYPES = {
  f8: ["Float64", Float64Array],
  f4: ["Float32", Float32Array],
  i8: ["BigInt64", BigInt64Array],
  u8: ["BigUint64", BigUint64Array],
  i4: ["Int32", Int32Array],
  u4: ["Uint32", Uint32Array],
  i2: ["Int16", Int16Array],
  u2: ["Uint16", Uint16Array],
  i1: ["Int8", Int8Array],
  u1: ["Uint8", Uint8Array],
  b1: ["Uint8", Uint8Array],
};
const PAGE = 65536; // bytes by which memory grows
const WORD = 8; // all records and arrays begin at multiples of it

/** An instance of the module. It works on one thing at a time: a game, say. */
export class Machine {
  /**
   * @param {WebAssembly.Instance} instance
   * @param {object} manifest
   */
  constructor(instance, manifest) {
    this.manifest = manifest;
    this.memory = instance.exports.memory;
    this.kernels = instance.exports;
    this.free = manifest.free;
    this._records = {};
  }

  /** @returns {DataView} the memory as it is; growing makes earlier views useless. */
  get view() {
    if (this._view?.buffer !== this.memory.buffer) this._view = new DataView(this.memory.buffer);
    return this._view;
  }

  /**
   * Reserve memory, which is zero.
   * @param {number} length in bytes
   * @returns {number} its address
   */
  reserve(length) {
    const address = Math.ceil(this.free / WORD) * WORD;
    this.free = address + length;
    const missing = this.free - this.memory.buffer.byteLength;
    if (missing > 0) this.memory.grow(Math.ceil(missing / PAGE));
    return address;
  }

  /** @returns {Uint8Array} the bytes at an address; it is of use until memory is reserved. */
  bytes(address, length) {
    return new Uint8Array(this.memory.buffer, address, length);
  }

  /**
   * @param {string} type "f4", say
   * @returns {*} the array at an address; it is of use until memory is reserved.
   */
  array(type, address, count) {
    return new TYPES[type][1](this.memory.buffer, address, count);
  }

  /**
   * @param {string} name "World", say
   * @returns {*} the record at an address; without one, a new record of zeros.
   */
  record(name, address = this.reserve(this.manifest.records[name].length)) {
    this._records[name] ??= recordClass(this.manifest.records[name]);
    return new this._records[name](this, address);
  }
}

/** Return the class of records with these fields, which lie at an address of a machine. */
function recordClass(described) {
  class Record {
    constructor(machine, address) {
      this.$machine = machine;
      this.$address = address;
    }

    /** All numbers by name, as a plain object. */
    plain() {
      const names = Object.keys(described.fields);
      return Object.fromEntries(names.map((name) => [name, plainOf(this[name])]));
    }
  }
  for (const [name, field] of Object.entries(described.fields)) {
    Object.defineProperty(Record.prototype, name, accessors(field));
  }
  return Record;
}

function plainOf(value) {
  if (typeof value !== "object") return value;
  return value.plain ? value.plain() : Array.from(value);
}

/** Return how a field is read and written: a number, an array, or a record within. */
function accessors({ type, place, shape }) {
  if (typeof type === "object") {
    const Inner = recordClass(type);
    return { get() { return new Inner(this.$machine, this.$address + place); } };
  }
  if (shape.length > 0) {
    const count = shape.reduce((one, other) => one * other, 1);
    return {
      get() { return this.$machine.array(type, this.$address + place, count); },
      set(values) { this.$machine.array(type, this.$address + place, count).set(values); },
    };
  }
  const word = TYPES[type][0];
  const read = DataView.prototype[`get${word}`];
  const write = DataView.prototype[`set${word}`];
  // A number, unless all its bits count: those of the random generator do.
  const shown = type === "i8" ? Number : (value) => value;
  const stored = word.startsWith("Big") ? BigInt : Number;
  return {
    get() { return shown(read.call(this.$machine.view, this.$address + place, true)); },
    set(value) { write.call(this.$machine.view, this.$address + place, stored(value), true); },
  };
}
