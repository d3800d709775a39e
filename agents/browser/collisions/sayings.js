// What the engine says of two bodies, in words and numbers.

const DIGITS = 5;
const INSEPARABLE = "Nothing separates them: they reach around each other.";

export class Sayings {
  /** @param {Record<string, () => void>} actions what the buttons do: relax, fly, bounce */
  constructor(actions) {
    this._buttons = {};
    for (const [name, act] of Object.entries(actions)) {
      this._buttons[name] = document.getElementById(`do-${name}`);
      this._buttons[name].onclick = () => {
        act();
        // Who uses keys goes on with what can be done next.
        Object.values(this._buttons).find((button) => !button.disabled)?.focus();
      };
    }
    const outputs = [...document.querySelectorAll("[data-says]")];
    this._outputs = Object.fromEntries(outputs.map((output) => [output.dataset.says, output]));
  }

  /** Show what the record of a meeting says. */
  show(bodies, record, algorithm) {
    const { a, b } = record;
    const overlap = record.overlap === 1;
    const separable = overlap && Number.isFinite(record.depth);
    const meets = Number.isFinite(record.time);
    this._say({
      detect: overlap ? "They overlap." : "They do not overlap.",
      algorithm,
      normal: overlap && pair(record.normal_x, record.normal_y),
      depth: overlap && number(record.depth),
      point: overlap && pair(record.point_x, record.point_y),
      separable: overlap && !separable ? INSEPARABLE : "",
      share_a: number(a.share),
      share_b: number(b.share),
      relaxed_a: separable && pair(a.relaxed_x, a.relaxed_y),
      relaxed_b: separable && pair(b.relaxed_x, b.relaxed_y),
      time: meets ? number(record.time) : "never",
      impact_normal: meets && pair(record.impact_normal_x, record.impact_normal_y),
      impact_point: meets && pair(record.impact_point_x, record.impact_point_y),
      restitution: number(record.restitution),
      approach: meets && number(record.approach),
      impulse: meets && number(record.impulse),
      before_a: pair(bodies.a.vx, bodies.a.vy),
      before_b: pair(bodies.b.vx, bodies.b.vy),
      bounced_a: meets && pair(a.bounced_vx, a.bounced_vy),
      bounced_b: meets && pair(b.bounced_vx, b.bounced_vy),
    });
    this._buttons.relax.disabled = !(separable && a.share + b.share > 0);
    this._buttons.fly.disabled = !meets || record.touching === 1;
    this._buttons.bounce.disabled = !(record.touching === 1 && record.impulse !== 0);
  }

  _say(values) {
    for (const [name, value] of Object.entries(values)) {
      const text = value === false ? "–" : value;
      const output = this._outputs[name];
      if (output.textContent !== text) output.textContent = text;
    }
  }
}

function number(value) {
  if (value === Infinity) return "∞";
  // Rounding may leave a tiny rest, or -0.
  const short = Number(value.toPrecision(DIGITS));
  const text = Math.abs(short) < 1e-12 ? "0" : String(short);
  return text.replace("-", "−");
}

function pair(x, y) {
  return `(${number(x)}, ${number(y)})`;
}
