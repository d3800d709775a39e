// A world to throw things in: the engine's `World`, by its kernels.

const GENERATION = 2 ** 32; // a handle is the index of a body, and how many had it before

/**
 * @typedef {object} Thing a body to throw in, see `physics/scenes/ready.py`
 * @property {string} collider the name of its class: "Particle", say
 * @property {string} polygon which one, if it is a "Convex"
 * @property {number} width also a disc's radius, and how many times larger a polygon is
 * @property {number} height of a rectangle
 * @property {number} turn in degrees
 * @property {number} x
 * @property {number} y
 * @property {number} vx
 * @property {number} vy
 * @property {number} mass 0: none
 * @property {number} restitution
 * @property {number} sensor 1: a sensor
 */

/**
 * @typedef {object} Happening a hit, or a body that enters or leaves a sensor
 * @property {number} kind one of `manifest.worlds.kinds`
 * @property {number} time
 * @property {number} a the handle of the body with the lower index
 * @property {number} b
 * @property {number[]} normal from a to b
 * @property {number[]} point
 * @property {number} impulse
 */

export class Sandbox {
  /**
   * @param {object} machine whose memory holds the tables of shapes
   * @param {Uint8Array} header with which a workspace begins
   */
  constructor(machine, header) {
    const { manifest } = machine;
    this.described = manifest.worlds;
    this._patterns = manifest.meetings.patterns;
    this._machine = machine;
    this._kernels = machine.kernels;
    this._header = header;
    this.record = machine.record("Sandbox");
    Object.assign(this.record, manifest.meetings.tables, this.described.numbers);
    const { blocks, tables } = this.described;
    this._blocks = machine.free;
    for (const [name, size] of Object.entries(blocks)) {
      this.record[name] = machine.reserve(Math.ceil(size / 64) * 64);
      this.record[`${name}_size`] = size;
    }
    this._size = machine.free - this._blocks;
    for (const [name, size] of Object.entries(tables)) this.record[name] = machine.reserve(size);
    const rows = (name, table) => {
      const { length } = manifest.records[name];
      const count = tables[table] / length;
      const first = this.record[table];
      return Array.from({ length: count }, (_, row) => machine.record(name, first + row * length));
    };
    this._bodies = rows("Seen", "bodies");
    this._hits = rows("Hit", "hits");
    this._rays = rows("Ray", "rays");
    this.clear();
  }

  /** Take everything out. */
  clear() {
    const { _machine: machine, record } = this;
    machine.bytes(this._blocks, this._size).fill(0);
    machine.bytes(record.workspace, this._header.length).set(this._header);
    record.goes_on = 0;
    this._pending = [];
    this._call("begin_world");
  }

  /**
   * Throw something in.
   * @param {Thing} thing
   * @returns {{handle: number, radius: number, corners: Float64Array} | undefined} its handle and
   *   its outline about its position, [x, y, x, y ...]; undefined: there is no room
   */
  add({ collider, polygon, sensor, ...numbers }) {
    const { record } = this;
    const name = collider === "Convex" ? `Convex ${polygon}` : collider;
    const pattern = this._patterns[name];
    if (pattern === undefined) throw new RangeError(`no collider ${name}`);
    Object.assign(record.figure, numbers, { pattern });
    record.sensor = sensor;
    this._call("add_body");
    const { handle, figure: { radius, corners, outline } } = record;
    if (handle < 0) return undefined;
    return { handle, radius, corners: outline.slice(0, 2 * corners) };
  }

  /** Remove a body. */
  remove(handle) {
    this.record.handle = handle;
    this._call("remove_body");
    this._keepEnds();
  }

  /** Put a body somewhere, with another velocity. */
  place(handle, x, y, vx, vy) {
    this.record.handle = handle;
    Object.assign(this.record.figure, { x, y, vx, vy });
    this._call("move_body");
    this._keepEnds();
  }

  /** Change the mass and the restitution of a body, and whether it is a sensor. */
  change(handle, { mass, restitution, sensor }) {
    this.record.handle = handle;
    Object.assign(this.record.figure, { mass, restitution });
    this.record.sensor = sensor;
    this._call("change_body");
    this._keepEnds();
  }

  /**
   * Step the world.
   * @param {number} dt how long
   * @param {number} [gravity] speed downwards that all gain before, in a unit of time
   * @returns {Happening[]} what happened
   * @throws {RangeError} the world can't go on: restore what was saved
   */
  step(dt, gravity = 0) {
    const { record, described: { outcomes, kinds } } = this;
    Object.assign(record, { dt, gravity });
    const events = this._pending;
    this._pending = [];
    do {
      this._call("step_world");
      events.push(...this._read());
    } while (record.outcome === outcomes.MORE);
    if (record.outcome === outcomes.CROWDED) {
      throw new RangeError(`more than ${record.pairs} bodies are inside sensors`);
    }
    if (record.outcome === outcomes.LOST) throw new RangeError("a number has become too large");
    // That a body left a sensor is known later than it happened.
    if (events.some(({ kind }) => kind === kinds.END)) events.sort((a, b) => a.time - b.time);
    return events;
  }

  /** @returns {object[]} all bodies as `Seen` records, of use until the next call; and the sums */
  see(gravity = 0) {
    this.record.gravity = gravity;
    this._call("see_world");
    return this._bodies.slice(0, this.record.count);
  }

  /** @returns {number[]} the handles of the bodies that overlap a disc, or contain a point */
  find(x, y, reach = 0) {
    const { record, _machine: machine } = this;
    Object.assign(record, { x, y, reach });
    this._call("find_bodies");
    return Array.from(machine.array("i8", record.found, record.count), Number);
  }

  /** @returns {object[]} rays in all directions, as `Ray` records: each says what it meets first */
  cast(x, y, reach) {
    Object.assign(this.record, { x, y, reach });
    this._call("cast_rays");
    return this._rays;
  }

  /** @returns {object} all that there is, for `restore` */
  save() {
    return {
      bytes: this._machine.bytes(this._blocks, this._size).slice(),
      pending: [...this._pending],
    };
  }

  restore({ bytes, pending }) {
    this._machine.bytes(this._blocks, this._size).set(bytes);
    this.record.goes_on = 0;
    this._pending = [...pending];
  }

  _call(kernel) {
    this._kernels[kernel](0, this.record.$address);
  }

  /** Read the events that a call has written. */
  _read() {
    return this._hits.slice(0, this.record.count).map((hit) => ({
      kind: hit.kind,
      time: hit.time,
      a: hit.a,
      b: hit.b,
      normal: [...hit.normal],
      point: [...hit.point],
      impulse: hit.impulse,
    }));
  }

  /** Keep the ends that an edit has caused: they are the next step's first events, in order. */
  _keepEnds() {
    if (this.record.count === 0) return;
    this._pending.push(...this._read());
    const order = (a, b) => (a % GENERATION) - (b % GENERATION);
    this._pending.sort((one, other) => order(one.a, other.a) || order(one.b, other.b));
  }
}
