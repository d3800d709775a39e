// Bodies in the address: #collide?a=Particle,0,0,1,0&b=Rectangle,3,0,0,0,2,1,30

/** The parts of a body, in their order, and what they are if they are missing. */
const PARTS = {
  collider: "Particle", x: 0, y: 0, vx: 0, vy: 0, width: 1, height: 1, turn: 0, mass: 1,
  restitution: 1, polygon: "pentagon", open: "",
};
/** What a number may be; a mass may be 0, too, but not so small that its inverse is infinite. */
export const LIMITS = {
  x: [-100, 100], y: [-100, 100], vx: [-100, 100], vy: [-100, 100], width: [0.1, 4],
  height: [0.1, 4], turn: [0, 359], mass: [1e-3, 1e3], restitution: [0, 1],
};
const WHOLE = ["turn", "sensor"];
export const COLLIDERS = [
  "Particle", "HalfPlane", "AxisAlignedHalfPlane", "AxisAlignedRectangle", "Rectangle", "Convex",
];
const EDGES = { triangle: 3, trapezium: 4, pentagon: 5 };

/** @returns {object} a body; what makes no sense is as if it were missing */
export function readBody(text) {
  const words = text.split(",");
  const body = {};
  Object.entries(PARTS).forEach(([name, usual], index) => {
    body[name] = words[index] ? readPart(name, words[index], usual, LIMITS[name]) : usual;
  });
  if (!COLLIDERS.includes(body.collider)) body.collider = PARTS.collider;
  if (!Object.hasOwn(EDGES, body.polygon)) body.polygon = PARTS.polygon;
  const missing = Array.from({ length: EDGES[body.polygon] }, (_, edge) => String(edge));
  const open = missing.filter((edge) => body.open.includes(edge));
  body.open = open.length < missing.length ? open.join("") : "";
  return body;
}

/** @returns {string | number} a word, as a number within its limits if it is one usually */
export function readPart(name, word, usual, limits) {
  if (typeof usual === "string") return word;
  const number = Number(word);
  if (!Number.isFinite(number)) return usual;
  if (name === "mass" && number === 0) return 0; // none
  const [low, high] = limits;
  return Math.max(low, Math.min(high, WHOLE.includes(name) ? Math.round(number) : number));
}

/** @returns {object} the bodies that an address holds: a, b, both or none */
export function readScene(hash) {
  const given = new URLSearchParams(hash.split("?")[1] ?? "");
  const sides = ["a", "b"].filter((side) => given.has(side));
  return Object.fromEntries(sides.map((side) => [side, readBody(given.get(side))]));
}

/** @returns {string} what an address holds of the bodies */
export function writeScene(bodies) {
  return ["a", "b"].map((side) => `${side}=${writeBody(bodies[side])}`).join("&");
}

function writeBody(body) {
  const words = Object.keys(PARTS).map((name) => String(body[name]));
  if (body.collider !== "Convex") words.length -= 2;
  return words.join(",").replace(/,+$/, "");
}
