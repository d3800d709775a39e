// The picture of a world. What lies where, kernels say: here it is only put on the screen.

const WIDTH = 24.9; // units that are shown, about the origin: a room of 24 x 16, and its walls
const HEIGHT = 16.6;
const LASTS = 0.5; // seconds that a hit is shown
const MOST_HITS = 80; // that are shown at once
const LAMP = 0.28; // radius
const POINT = 0.06; // radius of a point as it is drawn
export const AIM = 0.25; // length of an arrow for each unit of speed
const TIP = 0.16; // radius of the knob at an arrow's end

export class Arena {
  constructor() {
    this.canvas = document.getElementById("world-picture");
    this._context = this.canvas.getContext("2d");
    this._hits = [];
    this._colours = null;
    matchMedia("(prefers-color-scheme: dark)").onchange = () => { this._colours = null; };
  }

  /** @returns {number[]} where a pointer is in the world */
  place({ clientX, clientY }) {
    const box = this.canvas.getBoundingClientRect();
    return [
      ((clientX - box.left) / box.width - 0.5) * WIDTH,
      (0.5 - (clientY - box.top) / box.height) * HEIGHT,
    ];
  }

  /** @returns {number} how many units a pixel is */
  get unit() {
    return WIDTH / this.canvas.getBoundingClientRect().width;
  }

  /** @returns {number[]} the end of the arrow that is a body's velocity */
  tip({ x, y, vx, vy }) {
    return [x + AIM * vx, y + AIM * vy];
  }

  /** Show hits for a while. */
  note(hits, now) {
    for (const { point, normal } of hits.slice(-MOST_HITS)) this._hits.push({ point, normal, now });
    this._hits.splice(0, Math.max(0, this._hits.length - MOST_HITS));
  }

  forget() {
    this._hits = [];
  }

  /**
   * Draw a world.
   * @param {object[]} bodies as the world shows them
   * @param {Map<number, Path2D>} outlines of bodies, by handle
   * @param {object} shown what else there is: chosen, arrows, lamp, isRinged, rays, now
   */
  paint(bodies, outlines, { chosen, arrows, lamp, isRinged, rays, now }) {
    const context = this._context;
    this._fit();
    const colours = this._read();
    const scale = this.canvas.width / WIDTH;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.setTransform(scale, 0, 0, -scale, this.canvas.width / 2, this.canvas.height / 2);
    if (rays) this._paintRays(rays, colours, scale);
    const line = 1.5 * (globalThis.devicePixelRatio || 1) / scale;
    for (const body of bodies) {
      this._paintBody(body, outlines.get(body.handle), body.handle === chosen, colours, line);
    }
    if (arrows) {
      for (const body of bodies) {
        if (body.vx || body.vy || body.handle === chosen) {
          this._paintArrow(body, body.handle === chosen, colours, line);
        }
      }
    }
    this._paintHits(now, colours, line);
    if (lamp) this._paintLamp(lamp, isRinged, colours, line);
  }

  /** Let the canvas have as many pixels as the screen. */
  _fit() {
    const { canvas } = this;
    const width = Math.round(canvas.clientWidth * (globalThis.devicePixelRatio || 1));
    const height = Math.round(width * HEIGHT / WIDTH);
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  }

  _read() {
    if (!this._colours) {
      const style = getComputedStyle(this.canvas);
      const names = { dynamic: "a", kinematic: "b", hit: "normal", sensor: "after", fixed: "soft",
        ink: "ink", lamp: "lamp", ring: "accent" };
      const colour = ([name, variable]) => [name, style.getPropertyValue(`--${variable}`).trim()];
      this._colours = Object.fromEntries(Object.entries(names).map(colour));
    }
    return this._colours;
  }

  _paintBody({ x, y, vx, vy, mass, sensor }, outline, isChosen, colours, line) {
    const context = this._context;
    const moves = vx !== 0 || vy !== 0;
    let colour = Number.isFinite(mass) ? colours.dynamic : moves ? colours.kinematic : colours.fixed;
    if (sensor) colour = colours.sensor;
    context.save();
    context.translate(x, y);
    context.fillStyle = context.strokeStyle = colour;
    context.globalAlpha = sensor ? 0.12 : isChosen ? 0.5 : 0.28;
    context.fill(outline);
    context.globalAlpha = 1;
    if (sensor) context.setLineDash([5 * line, 4 * line]);
    context.lineWidth = isChosen ? 2.5 * line : line;
    context.stroke(outline);
    context.restore();
  }

  _paintArrow(body, isChosen, colours, line) {
    const context = this._context;
    const [x, y] = this.tip(body);
    context.strokeStyle = context.fillStyle = isChosen ? colours.hit : colours.ink;
    context.globalAlpha = isChosen ? 1 : 0.55;
    context.lineWidth = line;
    context.beginPath();
    context.moveTo(body.x, body.y);
    context.lineTo(x, y);
    context.stroke();
    this._disc(x, y, isChosen ? TIP : TIP / 2);
    context.fill();
    context.globalAlpha = 1;
  }

  _paintHits(now, colours, line) {
    const context = this._context;
    this._hits = this._hits.filter((hit) => now - hit.now < 1000 * LASTS);
    context.strokeStyle = context.fillStyle = colours.hit;
    context.lineWidth = 1.4 * line;
    for (const { point: [x, y], normal: [right, up], now: then } of this._hits) {
      context.globalAlpha = 1 - (now - then) / (1000 * LASTS);
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(x + 0.8 * right, y + 0.8 * up);
      context.stroke();
      this._disc(x, y, 0.09);
      context.fill();
    }
    context.globalAlpha = 1;
  }

  _paintRays(rays, colours, scale) {
    const context = this._context;
    const ends = rays.map(({ x, y, way_x: right, way_y: up, body, fraction }) => {
      const part = body < 0 ? 1 : fraction;
      return [x + part * right, y + part * up];
    });
    context.fillStyle = context.strokeStyle = colours.lamp;
    context.lineWidth = 1 / scale;
    context.globalAlpha = 0.16;
    context.beginPath();
    for (const end of ends) context.lineTo(...end);
    context.fill();
    context.globalAlpha = 0.5;
    context.beginPath();
    for (const end of ends) {
      context.moveTo(rays[0].x, rays[0].y);
      context.lineTo(...end);
    }
    context.stroke();
    context.globalAlpha = 1;
  }

  _paintLamp(lamp, isRinged, colours, line) {
    const context = this._context;
    context.fillStyle = colours.lamp;
    this._disc(...lamp, LAMP);
    context.fill();
    context.strokeStyle = colours.ink;
    context.lineWidth = line;
    context.stroke();
    if (!isRinged) return;
    context.strokeStyle = colours.ring;
    context.lineWidth = 2 * line; // 3 pixels, as around all else that has the focus
    this._disc(...lamp, LAMP + 2.5 * line);
    context.stroke();
  }

  _disc(x, y, radius) {
    this._context.beginPath();
    this._context.arc(x, y, radius, 0, 2 * Math.PI);
  }
}

/** @returns {Path2D} the outline of a body about its position */
export function pathOf({ radius, corners }) {
  const path = new Path2D();
  if (corners.length === 0) {
    path.arc(0, 0, Math.max(radius, POINT), 0, 2 * Math.PI);
    return path;
  }
  for (let corner = 0; corner < corners.length; corner += 2) {
    path.lineTo(corners[corner], corners[corner + 1]);
  }
  path.closePath();
  return path;
}
