// The stage: the picture as the kernels draw it, what is written over it, and the pointer on it.

import { make } from "arkanoid/data";

const NARROW = matchMedia("(max-width: 52rem)");
const MOST_SCALE = 120; // device pixels per brick width
const LEAST_SCALE = 8;
const PANEL = 21 * 16 + 32; // CSS pixels beside the picture: the panel and the gap
const LEAST_HEIGHT = 416; // CSS pixels; where less is visible, the controls are below
const SETTLED = 120; // milliseconds after which a window has its new size
const TAP = { seconds: 0.3, way: 10 }; // CSS pixels

/**
 * @typedef {object} Notice what is written over the picture
 * @property {string} [title]
 * @property {string[]} [lines]
 * @property {Array<[number[], boolean]>} [table] rows, and whether they are new
 * @property {Array<[string, () => void]>} [buttons] the first is the main one
 * @property {string} [small]
 * @property {boolean} [band] whether the picture is dimmed
 */

export class Stage {
  /** @param {{width: number, height: number, wall: number}} view */
  constructor(view) {
    this._view = view;
    this.frame = document.getElementById("frame");
    this.canvas = document.getElementById("picture");
    this.marks = document.getElementById("marks");
    this._notice = document.getElementById("notice");
    this._strip = document.getElementById("strip");
    this._pens = [this.canvas, this.marks].map((canvas) => canvas.getContext("2d"));
    document.documentElement.classList.toggle("touch", navigator.maxTouchPoints > 0);
    this.fit();
    const later = () => {
      clearTimeout(this._later);
      this._later = setTimeout(() => this.fit(), SETTLED);
    };
    addEventListener("resize", later);
    document.addEventListener("fullscreenchange", later);
  }

  /** Take the size that fits: whole pixels of the screen per brick. */
  fit() {
    const density = devicePixelRatio || 1;
    this._density = devicePixelRatio;
    const [width, height] = this._room();
    const { width: columns, height: rows } = this._view;
    const fitting = Math.floor(Math.min(width / columns, height / rows) * density);
    this.scale = Math.max(LEAST_SCALE, Math.min(MOST_SCALE, fitting));
    for (const canvas of [this.canvas, this.marks]) {
      canvas.width = columns * this.scale;
      canvas.height = rows * this.scale;
      canvas.style.width = `${canvas.width / density}px`;
      canvas.style.height = `${canvas.height / density}px`;
    }
    this._strip.style.width = this.canvas.style.width;
    document.querySelector(".bar").style.maxWidth = NARROW.matches ? "" : this.canvas.style.width;
    const wide = this.canvas.width / density + PANEL + 32;
    document.documentElement.style.setProperty("--wide", NARROW.matches ? "none" : `${wide}px`);
    this.stale = true;
  }

  /** Fit where the window has gone to another screen: browsers do not tell of it. */
  follow() {
    if (devicePixelRatio !== this._density) this.fit();
  }

  /** @returns {[number, number]} the CSS pixels that the picture may take */
  _room() {
    if (document.fullscreenElement) return [innerWidth, innerHeight];
    const { clientWidth } = document.body; // without the bar for scrolling
    const top = document.querySelector(".top").offsetHeight + 8;
    const bars = top + 52;
    if (!NARROW.matches) {
      const least = Math.min(LEAST_HEIGHT, innerHeight - top);
      return [clientWidth - PANEL - 32, Math.max(least, innerHeight - bars - 32)];
    }
    const strip = this._strip.offsetHeight;
    return [clientWidth, innerHeight - bars - (strip && strip + 8) - 8];
  }

  /** Draw a game. */
  paint(game) {
    const { width, height } = this.canvas;
    const pixels = game.draw(width, height);
    this._pens[0].putImageData(new ImageData(pixels, width, height), 0, 0);
    this.stale = false;
  }

  /** @returns {CanvasRenderingContext2D} an empty sheet over the picture, in brick widths */
  sheet() {
    const pen = this._pens[1];
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.marks.width, this.marks.height);
    pen.setTransform(this.scale, 0, 0, this.scale, 0, 0);
    return pen;
  }

  /** @param {Notice} notice */
  say(notice) {
    const { title = "", lines = [], table = [], buttons = [], small = "", band = false } = notice;
    const key = JSON.stringify([title, lines, table, buttons.map(([label]) => label), small, band]);
    if (key === this._said) return;
    this._said = key;
    const parts = [];
    if (title) parts.push(make("h2", {}, title));
    for (const line of lines) parts.push(make("p", {}, line));
    if (table.length) parts.push(tableOf(table));
    if (buttons.length) {
      const made = buttons.map(([label, action], index) => {
        const className = index ? "" : "first";
        return make("button", { type: "button", className, onclick: action }, label);
      });
      parts.push(make("div", { className: "buttons" }, ...made));
    }
    if (small) parts.push(make("p", { className: "small" }, small));
    this._notice.className = band ? "notice band" : "notice";
    this._notice.replaceChildren(...parts);
  }

  /** Offer a strip below the picture for steering by touch, or take it away. */
  offerStrip(offered) {
    this._strip.hidden = !offered;
    this.fit();
  }

  focus() {
    this.canvas.focus({ preventScroll: true });
  }

  /** Hide the mouse, or show it. */
  hide(hides) {
    this.frame.classList.toggle("hides", hides);
  }

  fillScreen() {
    if (document.fullscreenElement) document.exitFullscreen();
    else this.frame.requestFullscreen?.().catch(() => {});
  }

  /**
   * Listen to mouse and touch.
   * @param {{press: Function, release: Function, point: Function}} listener
   */
  listen(listener) {
    const touches = new Map();
    const down = (event) => {
      if (event.button !== 0 || event.target.closest("button")) return;
      event.currentTarget.setPointerCapture(event.pointerId);
      this.focus();
      event.preventDefault();
      if (event.pointerType === "mouse") {
        listener.point(...this._place(event), true);
        listener.press("fire");
        return;
      }
      if (touches.size) listener.press("fire");
      else listener.point(...this._place(event), true);
      touches.set(event.pointerId, event);
    };
    const move = (event) => {
      const first = touches.keys().next().value;
      const held = event.pointerType === "mouse" ? event.buttons > 0 : first === event.pointerId;
      if (event.pointerType === "mouse" || held) listener.point(...this._place(event), held);
    };
    const up = (event) => {
      const began = touches.get(event.pointerId);
      touches.delete(event.pointerId);
      const ended = event.type === "pointerup";
      if (ended && began && touches.size === 0 && isTap(began, event)) listener.press("fire");
      listener.release("fire");
    };
    for (const area of [this.frame, this._strip]) {
      area.addEventListener("pointerdown", down);
      area.addEventListener("pointermove", move);
      area.addEventListener("pointerup", up);
      area.addEventListener("pointercancel", up);
    }
  }

  /** @returns {[number, number]} where a pointer is in the field: x and y in brick widths */
  _place({ clientX, clientY }) {
    const { left, top, width } = this.canvas.getBoundingClientRect();
    const scale = width / this._view.width;
    const { height, wall } = this._view;
    return [(clientX - left) / scale - wall, height - (clientY - top) / scale];
  }
}

function isTap(began, ended) {
  const way = Math.hypot(began.clientX - ended.clientX, began.clientY - ended.clientY);
  return (ended.timeStamp - began.timeStamp) / 1000 < TAP.seconds && way < TAP.way;
}

function tableOf(rows) {
  const made = rows.map(([cells, isNew]) => {
    const row = make("tr", { className: isNew ? "new" : "" });
    row.append(...cells.map((cell) => make("td", {}, String(cell))));
    return row;
  });
  return make("table", {}, make("tbody", {}, ...made));
}
