// What is thrown in next, or the body that is chosen: its numbers, to choose and to type.

import { make } from "arkanoid/data";
import { KINDS, LIMITS, kindOf } from "arkanoid/things";

const MEASURES = { disc: ["radius"], box: ["width", "height"], "turned box": ["width", "height"] };
const TURNED = ["turned box", "triangle", "trapezium", "pentagon"];

export class Tray {
  /**
   * @param {object} usual a thing
   * @param {object} react functions: change(changes, isShape) of the thing that is shown
   */
  constructor(usual, { change }) {
    this.next = { ...usual, width: 0.8, height: 1.2 };
    this._change = change;
    this._form = document.getElementById("thing-form");
    this._fields = this._form.elements;
    this._fields.kind.append(...Object.keys(KINDS).map((name) => make("option", {}, name)));
    this._form.onsubmit = (event) => event.preventDefault();
    this._form.oninput = ({ target }) => this._read(target);
    // What can't be is put right when one goes on.
    this._form.onchange = ({ target }) => {
      if (target.type === "number") target.value = this._thing[target.name];
    };
    this.show(this.next, false);
  }

  /** Show a thing: the next one, or the body that is chosen. */
  show(thing, isChosen) {
    this._thing = thing;
    this._isChosen = isChosen;
    const kind = kindOf(thing);
    document.getElementById("thing-title").textContent =
      isChosen ? `This ${kind}` : "Throw in";
    for (const part of this._form.querySelectorAll(".for-chosen")) part.hidden = !isChosen;
    const isWall = kind === "wall";
    this._fields.kind.parentElement.hidden = isWall;
    if (!isWall) this._fields.kind.value = kind;
    this._show("width", MEASURES[kind]?.[0] ?? (kind === "point" || isWall ? undefined : "size"));
    this._show("height", MEASURES[kind]?.[1]);
    this._show("turn", TURNED.includes(kind) ? "rotation" : undefined);
    this._show("mass", isWall ? undefined : "mass");
    for (const name of Object.keys(LIMITS)) {
      const field = this._fields[name];
      // What somebody types is not written anew.
      if (!field || field.type === "checkbox") continue;
      if (field !== document.activeElement || field.type !== "number") field.value = thing[name];
    }
    this._fields.still.checked = thing.mass === 0;
    this._fields.mass.disabled = thing.mass === 0;
    this._fields.sensor.checked = thing.sensor === 1;
    for (const name of ["width", "height", "restitution"]) {
      document.getElementById(`thing-${name}-value`).value = thing[name];
    }
    document.getElementById("thing-turn-value").value = `${thing.turn}°`;
  }

  _show(name, title) {
    this._form.querySelector(`.for-${name}`).hidden = title === undefined;
    if (title && name === "width") {
      document.getElementById("thing-width-name").textContent = title;
    }
  }

  /** Take what a field says. */
  _read(field) {
    const { name } = field;
    if (name === "kind") {
      const kind = KINDS[field.value];
      const width = kind.width ?? (this._thing.width || 0.8);
      this._take({ ...kind, width }, true);
    } else if (name === "still") {
      this._take({ mass: field.checked ? 0 : 1 }, false);
    } else if (name === "sensor") {
      this._take({ sensor: Number(field.checked) }, false);
    } else {
      const number = field.valueAsNumber;
      const [low, high] = LIMITS[name];
      const isShape = ["width", "height", "turn"].includes(name);
      // Who types a mass of 0.5 begins with 0, which is none; for that there is a box.
      if (number >= low && number <= high) this._take({ [name]: number }, isShape);
    }
  }

  _take(changes, isShape) {
    if (this._isChosen) this._change(changes, isShape);
    else {
      Object.assign(this.next, changes);
      this.show(this.next, false);
    }
  }
}
