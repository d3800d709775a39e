// Things of a world in the address: #world?gravity=10&b=Particle,0,0,1,0&b=Rectangle,3,0,0,0,2,1,30

import { readPart } from "arkanoid/bodies";
import { readLamp } from "arkanoid/lamp";

/** What a number may be; a mass may be 0, too. */
export const LIMITS = {
  x: [-1e9, 1e9], y: [-1e9, 1e9], vx: [-1e6, 1e6], vy: [-1e6, 1e6], width: [0, 100],
  height: [0.1, 100], turn: [0, 359], mass: [1e-8, 1e8], restitution: [0, 1], sensor: [0, 1],
};
const COLLIDERS = [
  "Particle", "AxisAlignedHalfPlane", "AxisAlignedRectangle", "Rectangle", "Convex",
];
const LEAST = 0.1; // of a width, but a disc may be a point
const MOST_GRAVITY = 100;

/** What a thing of each name in the tray is. A point is a disc without a radius. */
export const KINDS = {
  disc: { collider: "Particle" },
  point: { collider: "Particle", width: 0 },
  box: { collider: "AxisAlignedRectangle" },
  "turned box": { collider: "Rectangle" },
  triangle: { collider: "Convex", polygon: "triangle" },
  trapezium: { collider: "Convex", polygon: "trapezium" },
  pentagon: { collider: "Convex", polygon: "pentagon" },
};

/** @returns {string} the name in the tray of a thing's kind; "wall" is not in it */
export function kindOf({ collider, polygon, width }) {
  if (collider === "Particle") return width === 0 ? "point" : "disc";
  if (collider === "AxisAlignedRectangle") return "box";
  if (collider === "Rectangle") return "turned box";
  return collider === "Convex" ? polygon : "wall";
}

/** The things of addresses, and scenes that are ready. */
export class Things {
  /** @param {object} described the manifest's `worlds` */
  constructor(described) {
    this.usual = described.thing;
    this._scenes = described.scenes;
    this._polygons = described.polygons;
  }

  /** @returns {object} a thing; what makes no sense is as if it were missing */
  read(text) {
    const words = text.split(",");
    const thing = {};
    Object.entries(this.usual).forEach(([name, usual], index) => {
      const word = words[index];
      thing[name] = word ? readPart(name, word, usual, LIMITS[name]) : usual;
    });
    if (!COLLIDERS.includes(thing.collider)) thing.collider = this.usual.collider;
    if (!Object.hasOwn(this._polygons, thing.polygon)) thing.polygon = this.usual.polygon;
    if (thing.collider !== "Particle") thing.width = Math.max(LEAST, thing.width);
    return thing;
  }

  _write(thing) {
    const words = Object.keys(this.usual).map((name) => String(thing[name]));
    const usual = Object.values(this.usual).map(String);
    while (words.length > 1 && words.at(-1) === usual[words.length - 1]) words.pop();
    return words.join(",");
  }

  /** @returns {object | undefined} the scene that an address holds; undefined: it holds none */
  readScene(hash) {
    const given = new URLSearchParams(hash.split("?")[1] ?? "");
    const name = given.get("scene") ?? "";
    if (Object.hasOwn(this._scenes, name)) return this.ready(name);
    if (!given.has("b") && !given.has("gravity") && !given.has("lamp")) return undefined;
    return {
      things: given.getAll("b").map((text) => this.read(text)),
      gravity: readPart("gravity", given.get("gravity") ?? "", 0, [0, MOST_GRAVITY]),
      lamp: readLamp(given.get("lamp") ?? ""),
    };
  }

  /** @returns {object} a scene that is ready */
  ready(name) {
    const { things, gravity, lamp } = this._scenes[name];
    return { name, things: things.map((text) => this.read(text)), gravity, lamp };
  }

  /** @returns {string} the address of a scene */
  writeScene({ name, things, gravity, lamp }) {
    if (name) return `#world?scene=${name}`;
    const parts = [`gravity=${gravity}`];
    if (lamp) parts.push(`lamp=${lamp.join(",")}`);
    return `#world?${[...parts, ...things.map((thing) => `b=${this._write(thing)}`)].join("&")}`;
  }
}
