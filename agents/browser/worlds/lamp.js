// The lamp, from where rays are sent: an element inside the picture, so that it can have the focus.

const SIDE = 12; // how far from the origin it can be: the picture shows a room of 24 x 16
const HEIGHT = 8;

export class Lamp {
  constructor() {
    this._element = document.getElementById("world-lamp");
  }

  /** Whether keys are its own. */
  get isFocused() {
    return document.activeElement === this._element;
  }

  /** Whether who looks should see that. */
  get isRinged() {
    const { classList } = document.documentElement;
    return this._element.matches(":focus-visible") && !classList.contains("points");
  }

  focus() {
    this._element.focus({ preventScroll: true });
  }

  /** Say where it is; null: there is none, and nothing to go to. */
  show(place) {
    this._element.hidden = !place;
    if (!place) return;
    const text = `Lamp at ${place.join(", ")}`.replaceAll("-", "−");
    if (this._element.getAttribute("aria-label") !== text) {
      this._element.setAttribute("aria-label", text);
    }
  }
}

/** @returns {number[] | null} where the lamp of an address is; what makes no sense is no place */
export function readLamp(text) {
  const words = text.split(",");
  const isPlace = words.length === 2 && words.every((word) => word && Number.isFinite(Number(word)));
  return isPlace ? lampAt(...words.map(Number)) : null;
}

/** @returns {number[]} a place that the picture shows: the nearest one */
export function lampAt(x, y) {
  return [within(x, SIDE), within(y, HEIGHT)];
}

function within(number, most) {
  return Math.max(-most, Math.min(most, Math.round(100 * number) / 100));
}
