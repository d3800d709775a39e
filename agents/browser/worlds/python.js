// The lines of Python that make a world.

const DIRECTIONS = ["+y", "-x", "-y", "+x"]; // of a half-plane at each quarter turn
const MOST_IN_A_LINE = 88;

/**
 * @param {object} scene its things and its gravity
 * @param {object} polygons the corners of each, by name
 * @returns {string} a program
 */
export function pythonOf({ things, gravity }, polygons) {
  const names = new Set(["Body", "World"]);
  const groups = [];
  for (const thing of things) {
    names.add(thing.collider);
    const rest = restOf(thing, polygons);
    if (groups.at(-1)?.rest.join() !== rest.join()) groups.push({ rest, motions: [] });
    groups.at(-1).motions.push(motionOf(thing));
  }
  const lines = [
    ...(things.some(isTurned) ? ["import math", ""] : []),
    ...importOf([...names].sort()),
    "",
    "world = World()",
    ...groups.flatMap(linesOf),
    "for _ in range(600):",
    ...(gravity ? pullOf(gravity) : []),
    "    for hit in world.step(1 / 60):",
    '        print(hit["time"], hit["a"], hit["b"])',
  ];
  return `${lines.join("\n")}\n`;
}

function importOf(names) {
  const line = `from arkanoid.physics import ${names.join(", ")}`;
  if (line.length <= MOST_IN_A_LINE) return [line];
  return ["from arkanoid.physics import (", ...filled(names), ")"];
}

function linesOf({ rest: [collider, more], motions }) {
  if (motions.length === 1) {
    const [motion] = motions;
    const place = motion.slice(0, 2).join(", ");
    return [`world.add(Body(${collider}, (${place})${velocity(motion)}${more})`];
  }
  const moves = motions.some((motion) => velocity(motion));
  const count = moves ? 4 : 2;
  const words = ["x", "y", "vx", "vy"].slice(0, count).join(", ");
  return [
    `for ${words} in [`,
    ...filled(motions.map((motion) => `(${motion.slice(0, count).join(", ")})`)),
    "]:",
    `    world.add(Body(${collider}, (x, y)${moves ? ", (vx, vy)" : ""}${more})`,
  ];
}

function velocity([, , vx, vy]) {
  return vx === "0" && vy === "0" ? "" : `, (${vx}, ${vy})`;
}

/** Put words into lines. */
function filled(words) {
  const lines = [];
  for (const word of words) {
    const longer = `${lines.at(-1)} ${word},`;
    if (lines.length > 0 && longer.length <= MOST_IN_A_LINE) lines[lines.length - 1] = longer;
    else lines.push(`    ${word},`);
  }
  return lines;
}

function pullOf(gravity) {
  return [
    "    for body in world.handles:",
    "        if world.body(body).mass is not None:",
    `            vx, vy = world.velocity(body)`,
    `            world.place(body, velocity=(vx, vy - ${gravity} * (1 / 60)))`,
  ];
}

function isTurned({ collider, turn }) {
  return turn !== 0 && (collider === "Rectangle" || collider === "Convex");
}

function motionOf({ x, y, vx, vy }) {
  return [x, y, vx, vy].map(String);
}

/** Return the collider, and what comes after the velocity; equal things have equal texts. */
function restOf(thing, polygons) {
  const { mass, restitution, sensor } = thing;
  const words = [
    mass > 0 && thing.collider !== "AxisAlignedHalfPlane" ? `, mass=${mass}` : "",
    restitution === 1 ? "" : `, restitution=${restitution}`,
    ")",
    sensor ? ", sensor=True" : "",
  ];
  return [colliderOf(thing, polygons), words.join("")];
}

function colliderOf(thing, polygons) {
  const { collider, width, height, turn } = thing;
  const angle = isTurned(thing) ? `math.radians(${turn})` : "";
  if (collider === "Particle") return `Particle(${width})`;
  if (collider === "AxisAlignedHalfPlane") {
    return `AxisAlignedHalfPlane("${DIRECTIONS[Math.floor(turn / 90)]}")`;
  }
  if (collider === "Convex") {
    const corners = polygons[thing.polygon].map(([x, y]) => `(${width * x}, ${width * y})`);
    return `Convex([${corners.join(", ")}]${angle && `, rotation=${angle}`})`;
  }
  return `${collider}(${width}, ${height}${angle && `, ${angle}`})`;
}
