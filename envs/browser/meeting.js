// Two bodies, and all that the engine says of them: a kernel computes it.

/**
 * @typedef {object} Figure a body
 * @property {string} collider the name of its class: "Particle", say
 * @property {string} polygon which one, if it is a "Convex"
 * @property {string} open the missing edges of a polygon: "02", say
 * @property {number} width also a disc's radius, and how many times larger a polygon is
 * @property {number} height of a rectangle
 * @property {number} turn in degrees
 * @property {number} x
 * @property {number} y
 * @property {number} vx
 * @property {number} vy
 * @property {number} mass 0: static
 * @property {number} restitution
 */

/** Two bodies. What is said of them are fields of `record`, see `physics/scenes/records.py`. */
export class Meeting {
  constructor(machine) {
    this._described = machine.manifest.meetings;
    this._kernels = machine.kernels;
    this.record = machine.record("Meeting");
    Object.assign(this.record, this._described.tables);
  }

  /**
   * Find all that the engine says of two bodies.
   * @param {Figure} a
   * @param {Figure} b
   * @returns {*} the record
   */
  meet(a, b) {
    this._write(this.record.a, a);
    this._write(this.record.b, b);
    this._kernels.meet(0, this.record.$address);
    return this.record;
  }

  /** The name of the algorithm that serves the pair. */
  get algorithm() {
    return this._described.algorithms[this.record.algorithm];
  }

  _write(figure, { collider, polygon, open, ...numbers }) {
    const name = collider === "Convex" ? `Convex ${polygon} ${open}`.trim() : collider;
    const pattern = this._described.patterns[name];
    if (pattern === undefined) throw new RangeError(`no collider ${name}`);
    Object.assign(figure, numbers, { pattern });
  }
}
