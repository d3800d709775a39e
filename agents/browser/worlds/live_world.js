// The bodies of a world with what the page knows of them: their shapes' names and outlines.

import { pathOf } from "arkanoid/arena";

const FAR = 60; // length of rays: beyond the picture from everywhere in it

export class Live {
  /** @param {object} sandbox see `worlds.js` of the game's modules */
  constructor(sandbox) {
    this.sandbox = sandbox;
    /** The outline of each body, by handle. */
    this.paths = new Map();
    this._shapes = new Map();
  }

  /** Put things into an empty world; return whether there was room. */
  lay(things) {
    this.sandbox.clear();
    this.paths.clear();
    this._shapes.clear();
    return things.every((thing) => this.add(thing) !== undefined);
  }

  /** @returns {number | undefined} the handle of a new body; undefined: there is no room */
  add(thing) {
    const added = this.sandbox.add(thing);
    if (!added) return undefined;
    const { collider, polygon, width, height, turn } = thing;
    this.paths.set(added.handle, pathOf(added));
    this._shapes.set(added.handle, { collider, polygon, width, height, turn });
    return added.handle;
  }

  remove(handle) {
    this.sandbox.remove(handle);
    this.paths.delete(handle);
    this._shapes.delete(handle);
  }

  change(handle, traits) {
    this.sandbox.change(handle, traits);
  }

  has(handle) {
    return this._shapes.has(handle);
  }

  place(handle, { x, y, vx, vy }) {
    this.sandbox.place(handle, x, y, vx, vy);
  }

  step(dt, gravity) {
    return this.sandbox.step(dt, gravity);
  }

  see(gravity) {
    return this.sandbox.see(gravity);
  }

  cast([x, y]) {
    return this.sandbox.cast(x, y, FAR);
  }

  /** @returns {number | undefined} the body at a place: the latest one, and not a wall */
  at(x, y, reach) {
    const found = this.sandbox.find(x, y, reach);
    return found.filter((handle) => this._shapes.get(handle)?.collider !== "AxisAlignedHalfPlane")
      .at(-1);
  }

  /** @returns {object | undefined} a body as a thing, as it is now */
  thing(handle) {
    if (!this.has(handle)) return undefined;
    return this._thing(this.sandbox.see().find((seen) => seen.handle === handle));
  }

  /** @returns {object[]} all bodies as things, in the order of their indices */
  things() {
    return this.sandbox.see().map((seen) => this._thing(seen));
  }

  /** @returns {number[]} all handles that can be chosen, in order */
  handles() {
    return this.sandbox.see().map(({ handle }) => handle);
  }

  _thing({ handle, x, y, vx, vy, mass, restitution, sensor }) {
    const shape = this._shapes.get(handle);
    const known = Number.isFinite(mass) ? mass : 0;
    return { ...shape, x, y, vx, vy, mass: known, restitution, sensor };
  }

  save() {
    return {
      sandbox: this.sandbox.save(), paths: new Map(this.paths), shapes: new Map(this._shapes),
    };
  }

  restore({ sandbox, paths, shapes }) {
    this.sandbox.restore(sandbox);
    this.paths = new Map(paths);
    this._shapes = new Map(shapes);
  }
}
