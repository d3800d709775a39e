// Keys and pointers: what they mean, and what they command. As in `envs/play/controls.py`.

/** What keys mean, by `KeyboardEvent.key`. */
export const KEYS = {
  ArrowLeft: "left", a: "left", ArrowRight: "right", d: "right", " ": "fire", p: "pause",
  r: "restart", n: "next", f: "full", m: "sound", t: "hand", "+": "faster", "=": "faster",
  "-": "slower", ".": "once",
};
/** These scroll the page, unless the field has the focus. */
export const FIELD_KEYS = { ArrowUp: "faster", ArrowDown: "slower" };

/** The paddle follows whichever was used last, the keys or the pointer. */
export class Controls {
  /** @param {number} steps the pointer's velocities are multiples of 1 / steps of the fastest */
  constructor(steps) {
    this._steps = steps;
    this.letGo();
  }

  press(key) {
    this._held.add(key);
    if (key === "fire") this._tapped = true;
    else if (key === "left" || key === "right") this._target = null;
  }

  release(key) {
    this._held.delete(key);
  }

  /** @param {number} x where the pointer is in the field, in brick widths */
  point(x) {
    this._target = x;
  }

  letGo() {
    this._held = new Set();
    this._tapped = false; // no tap is too short
    this._target = null;
  }

  /** @returns {[number, number]} velocity in [-1, 1] and fire (0 or 1) of the next tick */
  command(paddle, speed) {
    const fire = Number(this._tapped || this._held.has("fire"));
    this._tapped = false;
    if (this._target === null) {
      return [Number(this._held.has("right")) - Number(this._held.has("left")), fire];
    }
    const part = Math.max(-1, Math.min(1, (this._target - paddle) / speed));
    return [Math.round(part * this._steps) / this._steps, fire];
  }
}
