// What an agent thinks: how likely each of its actions is, and the rewards that it expects.

import { make } from "arkanoid/data";

const REMEMBERED = 1200; // ticks
const COMMANDS = ["LEFT", "RIGHT", "FIRE"];

/** @returns {string} an action's meaning, in words */
function wordsOf(meaning) {
  return meaning.replace("NOOP", "STAY").replace(/^(LEFT|RIGHT)(?=FIRE)/, "$1 + ").toLowerCase();
}

/** @returns {number[]} how much of the full speed goes to each side, and whether it fires */
function sharesOf([velocity, fire]) {
  const part = Math.max(-1, Math.min(1, velocity));
  return [Math.max(0, -part), Math.max(0, part), fire > 0 ? 1 : 0];
}

export class Thoughts {
  constructor() {
    this._box = document.getElementById("chances");
    this._value = document.getElementById("value");
    this._canvas = document.getElementById("values");
    this._pen = this._canvas.getContext("2d");
  }

  /** Begin with another agent, whose actions have these meanings; null: they are velocities. */
  begin(meanings) {
    this._values = [];
    this._rows = (meanings ?? COMMANDS).map((meaning) => {
      const bar = make("i");
      const number = make("b");
      const track = make("span", { className: "bar-of" }, bar);
      const row = make("div", {}, wordsOf(meaning), track, number);
      return { row, bar, number };
    });
    this._box.replaceChildren(...this._rows.map(({ row }) => row));
  }

  /** Remember what was expected in a tick. */
  note(value) {
    this._values.push(value);
    if (this._values.length > REMEMBERED) this._values.shift();
  }

  /** Forget a game. */
  forget() {
    this._values = [];
  }

  /** @param {Judgement} judgement see `network.js` */
  show({ action, value, probabilities }) {
    const shares = Array.isArray(action) ? sharesOf(action) : probabilities;
    this._rows.forEach(({ row, bar, number }, index) => {
      const chosen = Array.isArray(action) ? shares[index] > 0 : index === action;
      row.className = chosen ? "chosen" : "";
      bar.style.transform = `scaleX(${shares[index].toFixed(3)})`;
      number.textContent = `${Math.round(100 * shares[index])} %`;
    });
    this._value.value = value.toFixed(2);
    this._draw();
  }

  _draw() {
    const { _pen: pen, _canvas: canvas, _values: values } = this;
    const density = devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * density);
    const height = Math.round(canvas.clientHeight * density);
    const fits = canvas.width === width && canvas.height === height;
    if (!fits) Object.assign(canvas, { width, height });
    pen.clearRect(0, 0, width, height);
    const least = Math.min(0, ...values);
    const most = Math.max(0.001, ...values);
    const edge = 2 * density;
    const y = (value) => {
      return height - edge - ((value - least) / (most - least)) * (height - 2 * edge);
    };
    const style = getComputedStyle(canvas);
    pen.strokeStyle = style.getPropertyValue("--line");
    pen.lineWidth = density;
    pen.beginPath();
    pen.moveTo(0, y(0));
    pen.lineTo(width, y(0));
    pen.stroke();
    pen.strokeStyle = style.getPropertyValue("--accent");
    pen.lineWidth = 1.75 * density;
    pen.lineJoin = "round";
    pen.beginPath();
    values.forEach((value, index) => pen.lineTo((index / REMEMBERED) * width, y(value)));
    pen.stroke();
  }
}
