// What agents see: a vector by its parts, the field's planes, or pictures.

import { make } from "arkanoid/data";

/** The vector, part by part. */
export class Seen {
  /** @param {HTMLElement} box which is filled */
  constructor(box) {
    this._box = box;
  }

  /** Show what a game looks like to its agent. */
  show(game) {
    if (game !== this._game) this._begin(game);
    const vector = game.vector();
    this._cells.forEach((cell, index) => {
      if (!cell) return;
      const value = vector[index];
      cell.className = value < 0 ? "minus" : "";
      cell.style.setProperty("--much", Math.min(1, Math.abs(value)).toFixed(2));
    });
    const [first, last] = game.parts.vector.bricks;
    this._map.show(vector.subarray(first, last));
  }

  _begin(game) {
    this._game = game;
    this._cells = [];
    const { COLUMNS, ROWS } = game.machine.manifest.rules;
    this._map = new Plane(COLUMNS, ROWS);
    const rows = Object.entries(game.parts.vector).map(([name, [first, last]]) => {
      const values = make("span");
      if (name === "bricks") {
        values.append(this._map.canvas);
      } else {
        for (let place = first; place < last; place++) this._cells[place] = make("i");
        values.append(...this._cells.slice(first, last));
      }
      return make("div", {}, name.replaceAll("_", " "), values);
    });
    this._box.replaceChildren(...rows);
  }
}

/** The planes of the grid. */
export class Planes {
  /** @param {HTMLElement} box which is filled */
  constructor(box) {
    this._box = box;
  }

  show(game) {
    if (game !== this._game) this._begin(game);
    const grid = game.grid();
    const [, rows, columns] = game.shapes.grid;
    this._maps.forEach((map, plane) => {
      map.show(grid.subarray(plane * rows * columns, (plane + 1) * rows * columns));
    });
  }

  _begin(game) {
    this._game = game;
    const [count, rows, columns] = game.shapes.grid;
    this._maps = Array.from({ length: count }, () => new Plane(columns, rows));
    const figures = Object.entries(game.parts.grid).flatMap(([name, [first, last]]) => {
      return this._maps.slice(first, last).map((map, index) => {
        const text = last - first > 1 ? `${name} ${"xy"[index]}` : name;
        return make("figure", {}, map.canvas, text.replaceAll("_", " "));
      });
    });
    this._box.replaceChildren(...figures);
  }
}

/** The latest pictures, the newest last. */
export class Pictures {
  /** @param {HTMLElement} box which is filled */
  constructor(box) {
    this._box = box;
  }

  show(game, agent) {
    if (agent !== this._agent) this._begin(agent);
    const { pictures: seen, sees: { channels } } = agent;
    let place = 0;
    for (const [pen, image] of this._images) {
      for (let pixel = 0; pixel < image.data.length; pixel += 4, place += channels) {
        const colours = [0, channels >> 1, channels - 1].map((channel) => seen[place + channel]);
        image.data.set([...colours, 255], pixel);
      }
      pen.putImageData(image, 0, 0);
    }
  }

  _begin(agent) {
    this._agent = agent;
    const { size: [height, width], pictures } = agent.sees;
    const made = Array.from({ length: pictures }, () => {
      const canvas = make("canvas", { width, height, className: "map" });
      canvas.style.aspectRatio = `${width} / ${height}`;
      return canvas;
    });
    this._images = made.map((canvas) => [canvas.getContext("2d"), new ImageData(width, height)]);
    this._box.replaceChildren(...made.map((canvas) => make("figure", {}, canvas)));
  }
}

/** Numbers as colours, in rows. */
class Plane {
  constructor(columns, rows) {
    this.canvas = make("canvas", { width: columns, height: rows, className: "map" });
    this._pen = this.canvas.getContext("2d");
    const style = getComputedStyle(document.documentElement);
    this._colours = ["--plus", "--minus"].map((name) => numbersOf(style.getPropertyValue(name)));
    this._image = new ImageData(columns, rows);
  }

  show(numbers) {
    const { data } = this._image;
    numbers.forEach((number, place) => {
      const [red, green, blue] = this._colours[Number(number < 0)];
      data.set([red, green, blue, 255 * Math.min(1, Math.abs(number))], 4 * place);
    });
    this._pen.putImageData(this._image, 0, 0);
  }
}

/** @returns {number[]} red, green and blue of #rrggbb */
function numbersOf(colour) {
  return [1, 3, 5].map((place) => parseInt(colour.trim().slice(place, place + 2), 16));
}
