// Does with worlds what test_worlds.py says, and prints the answers: float64, as base64.
// node throw.mjs JOBS SOURCES MODULE MANIFEST

import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [jobs, sources, module, manifest] = process.argv.slice(2);
const { loadArkanoid } = await import(pathToFileURL(`${sources}/game.js`));
const arkanoid = await loadArkanoid(
  readFileSync(module),
  JSON.parse(readFileSync(manifest, "utf8")),
);

const sandbox = await arkanoid.sandbox();
let handles = [];
let saved;
const deeds = {
  clear: () => {
    sandbox.clear();
    handles = [];
  },
  add: (thing) => {
    handles.push(sandbox.add(thing).handle);
    return [handles.at(-1)];
  },
  remove: (body) => sandbox.remove(handles[body]),
  place: (body, ...motion) => sandbox.place(handles[body], ...motion),
  change: (body, traits) => sandbox.change(handles[body], traits),
  step: (dt, gravity) => {
    const events = sandbox.step(dt, gravity).flatMap(
      ({ kind, time, a, b, normal, point, impulse }) => [
        kind, time, a, b, ...normal, ...point, impulse,
      ],
    );
    const bodies = sandbox.see(gravity).flatMap(({ handle, x, y, vx, vy }) => [handle, x, y, vx, vy]);
    return [...events, ...bodies, sandbox.record.time, sandbox.record.capped];
  },
  find: (x, y, reach) => sandbox.find(x, y, reach),
  cast: (x, y, reach) => {
    return sandbox.cast(x, y, reach).flatMap(({ body, fraction, normal_x: nx, normal_y: ny }) => {
      return body < 0 ? [body] : [body, fraction, nx, ny];
    });
  },
  sums: (gravity) => {
    sandbox.see(gravity);
    const { energy, momentum_x: x, momentum_y: y } = sandbox.record;
    return [energy, x, y];
  },
  save: () => { saved = { sandbox: sandbox.save(), handles: [...handles] }; },
  restore: () => {
    sandbox.restore(saved.sandbox);
    handles = [...saved.handles];
  },
};
const answers = JSON.parse(readFileSync(jobs, "utf8")).map(([deed, ...given]) => {
  const numbers = new Float64Array(deeds[deed](...given) ?? []);
  return Buffer.from(numbers.buffer).toString("base64");
});
console.log(JSON.stringify(answers));
