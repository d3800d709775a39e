// The collision playground: two bodies, and live what the engine says of them.

import { Address } from "arkanoid/address";
import { readBody, readScene, writeScene } from "arkanoid/bodies";
import { Drawing } from "arkanoid/drawing";
import { Form } from "arkanoid/form";
import { Sayings } from "arkanoid/sayings";

const TURN = 5; // degrees for each key
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const MOST = { x: 8, y: 4.5, v: 9 }; // how far one can drag
const START = {
  a: readBody("Rectangle,-2.4,-1.2,2,1.4,2.2,1.2,25,2,0.8"),
  b: readBody("Particle,1.8,0.9,-0.5,-0.6,1,1,0,1,1"),
};

export class Collide {
  /** The page shows its scene instead of the game. */
  scene = "collide";
  steers = null;

  /** @param {object} app what all pages share, see `app.js` */
  constructor(app) {
    this.app = app;
    this.bodies = structuredClone(START);
    this.drawing = new Drawing({
      choose: (side) => this.choose(side),
      move: (side, x, y) => this.change(side, { x: within(x, MOST.x), y: within(y, MOST.y) }),
      aim: (side, vx, vy) => this.change(side, { vx: within(vx, MOST.v), vy: within(vy, MOST.v) }),
      press: (event, side, isTip) => this._press(event, side, isTip),
    });
    const { polygons } = app.arkanoid.manifest.meetings;
    this.form = new Form(polygons, {
      choose: (side) => this.choose(side),
      change: (changes) => this.change(this.side, changes),
    });
    this.sayings = new Sayings({
      relax: () => this._take((body, said) => ({ x: said.relaxed_x, y: said.relaxed_y })),
      fly: () => this._take((body, said) => ({ x: said.impact_x, y: said.impact_y })),
      bounce: () => this._take((body, said) => ({ vx: said.bounced_vx, vy: said.bounced_vy })),
    });
    this.side = "b";
    this._address = new Address(() => `#collide?${writeScene(this.bodies)}`);
  }

  async enter() {
    const turn = (this._turn = Symbol());
    this.meeting ??= await this.app.arkanoid.meeting();
    if (this._turn !== turn) return; // one came again meanwhile
    const scene = readScene(location.hash);
    Object.assign(this.bodies, scene);
    // One comes back.
    if (this.opened !== undefined && Object.keys(scene).length === 0) this._address.now();
    this.opened = location.hash;
    this.choose(this.side);
  }

  leave() {
    this._address.leave();
  }

  press() {}

  release() {}

  focus() {
    this.drawing.focus(this.side);
  }

  /** Show the numbers of one body in the form. */
  choose(side) {
    this.side = side;
    this.form.show(side, this.bodies[side]);
    this._show();
  }

  /** Change a body. */
  change(side, changes) {
    Object.assign(this.bodies[side], changes);
    this.choose(side);
    this._address.later();
  }

  _show() {
    const { a, b } = this.bodies;
    const record = this.meeting.meet(a, b);
    this.drawing.show(this.bodies, record, this.side);
    this.sayings.show(this.bodies, record, this.meeting.algorithm);
  }

  /** Take over what the engine says of both. */
  _take(changes) {
    const { record } = this.meeting;
    const taken = { a: changes(this.bodies.a, record.a), b: changes(this.bodies.b, record.b) };
    Object.assign(this.bodies.a, taken.a);
    this.change("b", taken.b);
  }

  /** React to a key on a body or on the tip of its velocity. */
  _press(event, side, isTip) {
    const body = this.bodies[side];
    const [right, up] = ARROWS[event.key] ?? [0, 0];
    if (right === 0 && up === 0) return false;
    this.choose(side);
    const step = event.altKey ? 0.01 : 0.1;
    const moved = (x, y) => [rounded(x + step * right), rounded(y + step * up)];
    if (isTip) {
      const [vx, vy] = moved(body.vx, body.vy);
      this.change(side, { vx, vy });
    } else if (!event.shiftKey) {
      const [x, y] = moved(body.x, body.y);
      this.change(side, { x, y });
    } else if (right) this.form.turn(-TURN * right);
    else this.form.enlarge(up);
    return true;
  }
}

function rounded(number) {
  return Math.round(100 * number) / 100;
}

function within(number, most) {
  return Math.max(-most, Math.min(most, rounded(number)));
}
