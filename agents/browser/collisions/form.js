// The numbers of one of the two bodies, to choose and to type.

import { COLLIDERS, LIMITS } from "arkanoid/bodies";
import { make } from "arkanoid/data";

const MEASURES = {
  Particle: ["radius"], AxisAlignedRectangle: ["width", "height"], Rectangle: ["width", "height"],
  Convex: ["size"],
};
// Steps in degrees.
const TURNS = { HalfPlane: 1, AxisAlignedHalfPlane: 90, Rectangle: 1, Convex: 1 };
const STEP = 0.1;

export class Form {
  /**
   * @param {Record<string, number>} polygons how many edges each has
   * @param {object} react functions: choose(side), and change(changes) of the body that is shown
   */
  constructor(polygons, { choose, change }) {
    this._polygons = polygons;
    this._change = change;
    this._form = document.getElementById("body-form");
    this._fields = this._form.elements;
    this._fields.collider.append(...COLLIDERS.map((name) => make("option", {}, name)));
    const names = Object.keys(polygons);
    this._fields.polygon.append(...names.map((name) => make("option", {}, name)));
    this._open = document.getElementById("open-edges");
    this._form.onsubmit = (event) => event.preventDefault();
    this._form.oninput = ({ target }) => {
      if (target.name === "side") choose(target.value);
      else this._read(target);
    };
    // What can't be is put right when one goes on.
    this._form.onchange = ({ target }) => {
      if (target.type === "number") target.value = this._body[target.name];
    };
    for (const button of this._form.querySelectorAll("[data-turn]")) {
      button.onclick = () => this.turn(Number(button.dataset.turn));
    }
  }

  /** Show a body. */
  show(side, body) {
    this._side = side;
    this._body = body;
    this._fields.side.value = side;
    for (const name of ["collider", "polygon", ...Object.keys(LIMITS)]) {
      const field = this._fields[name];
      // What somebody types is not written anew.
      if (field !== document.activeElement || field.type !== "number") field.value = body[name];
    }
    this._fields.still.checked = body.mass === 0;
    this._fields.mass.disabled = body.mass === 0;
    this._showWhatFits(body);
    for (const name of ["width", "height", "restitution"]) {
      document.getElementById(`${name}-value`).value = body[name];
    }
    document.getElementById("turn-value").value = `${body.turn}°`;
  }

  /** Make the body that is shown larger or smaller by some steps. */
  enlarge(steps) {
    const { width, height, collider } = this._body;
    if (!MEASURES[collider]) return;
    const [low, high] = LIMITS.width;
    const enlarged = (measure) => {
      return Math.max(low, Math.min(high, Math.round(100 * (measure + STEP * steps)) / 100));
    };
    this._change({ width: enlarged(width), height: enlarged(height) });
  }

  /** Hide the fields that this collider does not have. */
  _showWhatFits({ collider, polygon, open }) {
    const [first, second] = MEASURES[collider] ?? [];
    const isPolygon = collider === "Convex";
    const shown = { polygon: isPolygon, width: first, height: second, turn: TURNS[collider] };
    for (const [name, fits] of Object.entries(shown)) {
      this._form.querySelector(`.for-${name}`).hidden = !fits;
    }
    if (first) document.getElementById("width-name").textContent = first;
    this._fields.turn.step = TURNS[collider] ?? 1;
    this._fields.turn.max = collider === "AxisAlignedHalfPlane" ? 270 : 359;
    this._open.hidden = !isPolygon;
    const key = `${polygon} ${open}`;
    if (this._open.dataset.shown === key) return;
    this._open.dataset.shown = key;
    const focused = document.activeElement?.name === "edge" && document.activeElement.value;
    this._open.querySelector("div").replaceChildren(...this._edges(polygon, open));
    if (focused) this._open.querySelector(`[value="${focused}"]`)?.focus();
  }

  _edges(polygon, open) {
    const count = this._polygons[polygon];
    return Array.from({ length: count }, (_, edge) => {
      const checked = open.includes(String(edge));
      // One edge must be there.
      const disabled = !checked && open.length === count - 1;
      const value = String(edge);
      const box = make("input", { type: "checkbox", name: "edge", value, checked, disabled });
      return make("label", { className: "check" }, box, value);
    });
  }

  /** Turn the body that is shown, if it can be turned. */
  turn(by) {
    const least = TURNS[this._body.collider];
    if (!least) return;
    const step = Math.sign(by) * Math.max(least, Math.abs(by));
    this._change({ turn: (this._body.turn + step + 360) % 360 });
  }

  /** Take what a field says. */
  _read(field) {
    const { name, value } = field;
    if (name === "edge") {
      const checked = [...this._form.querySelectorAll("[name=edge]:checked")];
      this._change({ open: checked.map((box) => box.value).join("") });
    } else if (name === "still") {
      this._change({ mass: field.checked ? 0 : 1 });
    } else if (name === "polygon") {
      this._change({ polygon: value, open: "" });
    } else if (name === "collider") {
      this._change({ collider: value });
    } else {
      const number = field.valueAsNumber;
      const [low, high] = LIMITS[name];
      // Who types a mass of 0.5 begins with 0, which is none; for that there is a box.
      if (number >= low && number <= high) this._change({ [name]: number });
    }
  }
}
