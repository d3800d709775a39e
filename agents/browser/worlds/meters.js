// What a world says in numbers: energy, momentum, hits, and who is inside sensors.

const KEPT = 240; // energies of the curve
const EVERY = 100; // milliseconds between two numbers that one can read
const LINES = 6; // of the list of events
const DIGITS = 4;

export class Meters {
  /** @param {object} kinds the manifest's numbers of kinds of events */
  constructor(kinds) {
    this._kinds = kinds;
    this._canvas = document.getElementById("energy-curve");
    this._events = document.getElementById("world-events");
    const outputs = [...document.querySelectorAll("[data-world]")];
    this._outputs = Object.fromEntries(outputs.map((output) => [output.dataset.world, output]));
    this.clear();
  }

  clear() {
    this.hits = 0;
    this._energies = [];
    this._lines = [];
    this._shown = -Infinity;
  }

  /** @returns {object} all that there is, for `restore` */
  save() {
    return { hits: this.hits, energies: [...this._energies], lines: [...this._lines] };
  }

  restore({ hits, energies, lines }) {
    this.hits = hits;
    this._energies = [...energies];
    this._lines = [...lines];
    this._shown = -Infinity;
  }

  /** Take note of what happened in a step. */
  note(events, energy) {
    const { HIT, BEGIN } = this._kinds;
    for (const { kind, time, a, b } of events) {
      if (kind === HIT) {
        this.hits += 1;
        continue;
      }
      const word = kind === BEGIN ? "BEGIN" : "END";
      this._lines.push(`${time.toFixed(2)}  ${word}  bodies ${nameOf(a)} and ${nameOf(b)}`);
    }
    this._lines.splice(0, Math.max(0, this._lines.length - LINES));
    this._energies.push(energy);
    if (this._energies.length > KEPT) this._energies.shift();
  }

  /** Show the numbers, not more often than one can read. */
  show(record, bodies, now) {
    if (now - this._shown < EVERY) return;
    this._shown = now;
    const { time, energy, momentum_x: x, momentum_y: y, capped } = record;
    this._say({
      time: time.toFixed(2),
      bodies: String(bodies),
      hits: String(this.hits),
      energy: number(energy),
      momentum: `(${number(x)}, ${number(y)})`,
      capped: capped ? `A body without room, or with too many hits: ${capped} times.` : "",
    });
    const text = this._lines.join("\n");
    if (this._events.textContent !== text) this._events.textContent = text;
    this._events.parentElement.hidden = text === "";
    this._paint();
  }

  _say(values) {
    for (const [name, value] of Object.entries(values)) {
      const output = this._outputs[name];
      if (output.textContent !== value) output.textContent = value;
    }
  }

  /** Draw the curve of energy, from 0 up. */
  _paint() {
    const { _canvas: canvas, _energies: energies } = this;
    const ratio = globalThis.devicePixelRatio || 1;
    const width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round(canvas.clientHeight * ratio);
    if (width === 0) return;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const context = canvas.getContext("2d");
    context.clearRect(0, 0, width, height);
    const low = Math.min(0, ...energies);
    const high = Math.max(0, ...energies);
    const room = 2 * ratio;
    const rise = (height - 2 * room) / (1.15 * (high - low) || 1);
    context.strokeStyle = getComputedStyle(canvas).getPropertyValue("--a");
    context.lineWidth = 2 * ratio;
    context.beginPath();
    energies.forEach((energy, index) => {
      context.lineTo(index * width / (KEPT - 1), height - room - (energy - low) * rise);
    });
    context.stroke();
  }
}

/** @returns {string} the index of a body, which is short */
export function nameOf(handle) {
  return String(handle % 2 ** 32);
}

/** @returns {string} a number for people */
export function number(value) {
  const short = Number(value.toPrecision(DIGITS));
  return (Math.abs(short) < 1e-9 ? "0" : String(short)).replace("-", "−");
}
