// The hand in a world: pointer and keys that drag, fling, aim and throw in.

import { AIM } from "arkanoid/arena";
import { lampAt } from "arkanoid/lamp";

const REACH = 10; // pixels about a pointer in which a body is taken
const FASTEST = 60; // that a hand moves, in units of the world
const STILL = 0.15; // units by which one must pull to throw
const NUDGE = 0.1;
const LEAP = 1;
const KICK = 1;
const REMEMBERED = 100; // milliseconds of a pointer's way that make a fling
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

export class Hand {
  /** @param {object} world the part of the page */
  constructor(world) {
    this._world = world;
    this._held = undefined;
    const { canvas } = world.arena;
    canvas.addEventListener("pointerdown", (event) => this._grab(event));
    canvas.addEventListener("pointermove", (event) => this._isHeld(event) && this._move(event));
    canvas.addEventListener("pointerup", (event) => this._isHeld(event) && this._let(event));
    canvas.addEventListener("pointercancel", (event) => this._isHeld(event) && this.cancel());
    canvas.addEventListener("keydown", (event) => {
      if (!this._press(event)) return;
      event.preventDefault();
      event.stopPropagation();
    });
  }

  /** Whether time stands still, because somebody aims. */
  get aims() {
    return this._held?.what === "aim" || this._held?.what === "tip";
  }

  /** Hold nothing any more. */
  drop() {
    this._held = undefined;
  }

  /** Take back what the pointer does; a body that it holds while time runs flies on. */
  cancel() {
    if (!this._held) return;
    if (this.aims || !this._world.runs) {
      this._world.undo();
      return;
    }
    this.drop();
    this._world.edited();
  }

  /** Whether an event is of the pointer that holds something, and not of a second finger. */
  _isHeld({ pointerId }) {
    return this._held?.pointer === pointerId;
  }

  /** Let a body that is held fly to the pointer in the next step. */
  pull(dt) {
    if (this._held?.what !== "body") return;
    const { live } = this._world;
    const thing = live.thing(this._held.handle);
    if (!thing) {
      this.drop();
      return;
    }
    const [x, y] = this._goal();
    if (thing.mass === 0) {
      live.place(this._held.handle, { ...thing, x, y });
      return;
    }
    const most = (speed) => Math.max(-FASTEST, Math.min(FASTEST, speed));
    const [vx, vy] = [most((x - thing.x) / dt), most((y - thing.y) / dt)];
    live.place(this._held.handle, { ...thing, vx, vy });
  }

  _goal() {
    const { at: [x, y], grip: [dx, dy] } = this._held;
    return [x - dx, y - dy];
  }

  _grab(event) {
    if (event.button > 0 || this._held) return;
    const { _world: world } = this;
    event.preventDefault();
    world.focus();
    world.arena.canvas.setPointerCapture(event.pointerId);
    const [x, y] = world.arena.place(event);
    const { what, handle, from = [x, y] } = this._find(x, y);
    if (what === undefined) return;
    const grip = [x - from[0], y - from[1]];
    const trail = [[x, y, event.timeStamp]];
    this._held = {
      pointer: event.pointerId, what, handle, at: [x, y], from: [x, y], grip, trail,
    };
    if (what === "lamp") world.spot.focus();
  }

  /** Find what is at a place: the lamp, a tip, a body, or room for what is thrown in. */
  _find(x, y) {
    const { _world: world } = this;
    const { arena, live } = world;
    const reach = REACH * arena.unit;
    const near = ([their, own]) => Math.hypot(their - x, own - y) < 1.5 * reach;
    const chosen = world.runs ? undefined : live.thing(world.chosen);
    if (world.lamp && near(world.lamp)) {
      world.remember();
      return { what: "lamp", from: world.lamp };
    }
    if (chosen && (chosen.vx || chosen.vy) && near(arena.tip(chosen))) {
      world.remember();
      return { what: "tip", handle: world.chosen, from: arena.tip(chosen) };
    }
    const handle = live.at(x, y, 0) ?? live.at(x, y, reach);
    if (handle !== undefined) {
      const thing = live.thing(handle);
      world.remember();
      world.choose(handle);
      return { what: "body", handle, from: [thing.x, thing.y] };
    }
    const thrown = world.throwIn(rounded(x), rounded(y));
    if (thrown === undefined) return {};
    world.choose(undefined);
    return { what: "aim", handle: thrown };
  }

  _move(event) {
    const held = this._held;
    const { _world: world } = this;
    held.at = world.arena.place(event);
    held.trail.push([...held.at, event.timeStamp]);
    while (event.timeStamp - held.trail[0][2] > REMEMBERED) held.trail.shift();
    const [x, y] = this._goal();
    if (held.what === "lamp") world.lamp = lampAt(x, y);
    else if (held.what === "tip") this._aim(held.handle, held.at, held.grip);
    else if (held.what === "aim") this._throw(held);
    else if (!world.runs) {
      const thing = world.live.thing(held.handle);
      if (thing) world.live.place(held.handle, { ...thing, x: rounded(x), y: rounded(y) });
    }
  }

  /** Let the arrow of a body end at a place. */
  _aim(handle, [x, y], [dx, dy]) {
    const { live } = this._world;
    const thing = live.thing(handle);
    if (!thing) return;
    const speed = (to, from) => rounded((to - from) / AIM);
    live.place(handle, { ...thing, vx: speed(x - dx, thing.x), vy: speed(y - dy, thing.y) });
  }

  /** Let what was thrown in have the velocity that one pulls; none, if one only taps. */
  _throw({ handle, at, from: [x, y] }) {
    const pulled = Math.hypot(at[0] - x, at[1] - y) > STILL;
    this._aim(handle, pulled ? at : [x, y], [0, 0]);
  }

  _let(event) {
    const held = this._held;
    const { _world: world } = this;
    this._held = undefined;
    if (held.what === "body" && world.runs) this._fling(held, event.timeStamp);
    const isMoved = held.at.join() !== held.from.join();
    // A body stops in the hand while time runs.
    const isSame = !isMoved && held.what !== "aim" && !(held.what === "body" && world.runs);
    if (isSame) world.forgetLast();
    else world.edited();
    world.choose(world.chosen);
  }

  /** Give a body the velocity of the pointer. */
  _fling({ handle, trail }, now) {
    const { live } = this._world;
    const thing = live.thing(handle);
    if (!thing || thing.mass === 0) return;
    const way = trail.filter(([, , then]) => now - then <= REMEMBERED);
    let [vx, vy] = [0, 0];
    if (way.length > 1) {
      const [first, last] = [way[0], way.at(-1)];
      const seconds = Math.max(0.008, (last[2] - first[2]) / 1000);
      [vx, vy] = [0, 1].map((axis) => {
        return Math.max(-FASTEST, Math.min(FASTEST, (last[axis] - first[axis]) / seconds));
      });
    }
    live.place(handle, { ...thing, vx, vy });
  }

  /** React to a key on the picture; return whether it has a meaning. */
  _press(event) {
    const { _world: world } = this;
    const { key } = event;
    if (event.ctrlKey || event.metaKey) {
      if (key.toLowerCase() !== "z") return false;
      world.undo();
      return true;
    }
    const deeds = {
      " ": () => world.pause(),
      ".": () => world.once(),
      "+": () => world.hurry(1),
      "-": () => world.hurry(-1),
      r: () => world.again(),
      n: () => this._next(event.shiftKey ? -1 : 1),
      i: () => this._insert(),
      Delete: () => this._remove(),
      Backspace: () => this._remove(),
      Escape: () => world.choose(undefined),
    };
    const deed = deeds[key.length === 1 ? key.toLowerCase() : key];
    if (deed) {
      deed();
      return true;
    }
    return Object.hasOwn(ARROWS, key) && this._nudge(ARROWS[key], event);
  }

  /** Move what the keys are for: the lamp, or the chosen body. */
  _nudge([right, up], event) {
    const { _world: world } = this;
    if (!world.spot.isFocused) return this._nudgeBody([right, up], event);
    const [x, y] = world.lamp;
    const step = event.shiftKey ? LEAP : NUDGE;
    if (!event.repeat) world.remember();
    world.lamp = lampAt(x + step * right, y + step * up);
    world.edited();
    return true;
  }

  /** Move the chosen body, or kick it while time runs or with the shift key. */
  _nudgeBody([right, up], event) {
    const { _world: world } = this;
    const thing = world.live.thing(world.chosen);
    if (!thing) return false;
    if (!event.repeat) world.remember();
    const kicks = event.shiftKey || (world.runs && thing.mass > 0);
    const step = kicks ? KICK : NUDGE;
    const [x, y] = kicks ? ["vx", "vy"] : ["x", "y"];
    if (right) thing[x] = rounded(thing[x] + step * right);
    if (up) thing[y] = rounded(thing[y] + step * up);
    world.live.place(world.chosen, thing);
    world.edited();
    return true;
  }

  _remove() {
    const { _world: world } = this;
    if (world.spot.isFocused) world.light(null);
    else world.remove();
  }

  /** Choose the next body. */
  _next(by) {
    const { _world: world } = this;
    world.focus();
    const handles = world.live.handles();
    if (handles.length === 0) return;
    const place = handles.indexOf(world.chosen);
    const next = place < 0 ? (by > 0 ? 0 : handles.length - 1) : place + by;
    world.choose(handles[(next + handles.length) % handles.length]);
    world.tell(world.chosen);
  }

  /** Throw something into the middle, and choose it. */
  _insert() {
    const { _world: world } = this;
    world.focus();
    const handle = world.throwIn(0, 0);
    if (handle === undefined) return;
    world.choose(handle);
    world.edited();
  }
}

/** @returns {number} a number that makes a short address */
function rounded(number) {
  return Math.round(100 * number) / 100;
}
