// A training's curves, and how far it is.

import { make } from "arkanoid/data";

const SVG = "http://www.w3.org/2000/svg";
const [WIDTH, HEIGHT, EDGE] = [100, 40, 3]; // of a picture, in its own units
// In English, as the page.
const VALUE = new Intl.NumberFormat("en", { maximumSignificantDigits: 3 });
const COUNT = new Intl.NumberFormat("en", { notation: "compact", maximumSignificantDigits: 3 });

/** The panel's part about a run. */
export class Training {
  /** @param {HTMLElement} section which is filled */
  constructor(section) {
    this._section = section;
    [this._said, this._done, this._agent, this._box, this._range] = [
      "said", "done", "agent", "curves", "range",
    ].map((name) => section.querySelector(`[data-run=${name}]`));
    this._curves = new Map();
  }

  /** @param {News} news of `following.js` */
  show({ state, said, done, curves, agent }) {
    this._section.hidden = false;
    this._said.textContent = said;
    this._said.className = state === "lost" ? "lost" : "";
    this._done.hidden = state === "finished" || state === "lost";
    this._done.value = done ?? 0;
    this._agent.textContent = agent;
    for (const curve of curves) {
      if (!this._curves.has(curve.title)) this._curves.set(curve.title, new Curve(curve.title));
    }
    const most = Math.max(1, ...curves.map(({ steps }) => steps.at(-1)));
    const shown = curves.map((curve) => this._curves.get(curve.title).show(curve, most));
    if (shown.some((figure, index) => figure !== this._box.children[index])) {
      this._box.replaceChildren(...shown);
    }
    this._range.hidden = !curves.length;
    this._range.textContent = `0 to ${COUNT.format(most)} decisions. Point to read a value.`;
  }
}

class Curve {
  constructor(title) {
    this._title = make("span", {}, title);
    this._value = make("b");
    [this._most, this._least] = [make("span"), make("span")];
    this._picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none" });
    this._picture.setAttribute("role", "img");
    [this._line, this._dot] = [svg("path"), svg("path", { class: "dot" })];
    this._picture.append(this._line, this._dot);
    this._picture.onpointermove = ({ offsetX }) => {
      const x = (offsetX / this._picture.clientWidth) * WIDTH;
      this._point(this._nearest(((x - EDGE) / (WIDTH - 2 * EDGE)) * this._end));
    };
    this._picture.onpointerleave = () => this._point(-1);
    const scale = make("div", { className: "scale", ariaHidden: "true" }, this._most, this._least);
    this._figure = make("figure", {},
      make("figcaption", {}, this._title, this._value), this._picture, scale);
    this._name = title;
    this._at = -1;
  }

  /** Draw a curve from 0 to some decisions. @returns {HTMLElement} */
  show({ steps, values }, end) {
    Object.assign(this, { _steps: steps, _values: values, _end: end });
    const [least, most] = [Math.min(...values), Math.max(...values)];
    const flat = most === least;
    this._y = (value) => {
      const part = flat ? 0.5 : (value - least) / (most - least);
      return HEIGHT - EDGE - part * (HEIGHT - 2 * EDGE);
    };
    this._most.textContent = VALUE.format(most);
    this._least.textContent = flat ? "" : VALUE.format(least);
    const places = values.map((_, index) => this._place(index));
    this._line.setAttribute("d", `M${places.join("L")}`);
    const last = VALUE.format(values.at(-1));
    this._picture.setAttribute("aria-label", `${this._name}: ${last} after ${COUNT.format(end)}`);
    this._point(this._at);
    return this._figure;
  }

  /** Show a point, and say what it is; -1: the last one. */
  _point(index) {
    const last = this._steps.length - 1;
    this._at = index;
    const shown = index < 0 || index > last ? last : index;
    const value = VALUE.format(this._values[shown]);
    const when = index < 0 ? "" : ` at ${COUNT.format(this._steps[shown])}`;
    this._value.textContent = `${value}${when}`;
    this._dot.setAttribute("d", `M${this._place(shown)}h0`);
  }

  _place(index) {
    const x = EDGE + (this._steps[index] / this._end) * (WIDTH - 2 * EDGE);
    return `${x.toFixed(2)} ${this._y(this._values[index]).toFixed(2)}`;
  }

  _nearest(step) {
    const apart = this._steps.map((one) => Math.abs(one - step));
    return apart.indexOf(Math.min(...apart));
  }
}

function svg(tag, attributes = {}) {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}
