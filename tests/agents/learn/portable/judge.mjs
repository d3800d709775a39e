// Lets agents play, and prints what they did and how their games stand.
// node judge.mjs JOBS SOURCES MODULE MANIFEST FOLDER

import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [jobs, sources, module, manifest, folder] = process.argv.slice(2);
const source = (name) => import(pathToFileURL(`${sources}/${name}`));
const { loadArkanoid } = await source("game.js");
const { Agent } = await source("network.js");
const arkanoid = await loadArkanoid(
  readFileSync(module),
  JSON.parse(readFileSync(manifest, "utf8")),
);
const found = {};
for (const { name, game: played, decisions } of JSON.parse(readFileSync(jobs, "utf8"))) {
  const game = await arkanoid.open(played);
  const agent = new Agent(game, readFileSync(`${folder}/${name}.network`));
  const { kind } = agent.sees;
  game.reset({ seed: 5 });
  const seen = [];
  const said = [];
  let action = 0;
  for (let decision = 0; decision < decisions; decision++) {
    // By tick, an action is held as long as the agent knows it.
    if (!played.includes("tick") || game.world.decisions % agent.config.frame_skip === 0) {
      const judged = agent.judge();
      ({ action } = judged);
      const shown = agent.pictures ?? game[kind]();
      seen.push(Buffer.from(new Uint8Array(shown.buffer, shown.byteOffset, shown.byteLength)));
      said.push(...[action].flat(), judged.value, ...judged.probabilities);
    } else if (kind === "rgb" && decision % 3 === 0) {
      agent.judge(); // as where a player takes over: it must not change what is seen later
    }
    game.step(action);
    if (game.over) game.reset();
  }
  writeFileSync(`${folder}/${name} ${played}.seen`, Buffer.concat(seen));
  writeFileSync(`${folder}/${name} ${played}.said`, new Float64Array(said));
  found[`${name} ${played}`] = game.info;
}
for (const [name, other] of [["lite", "full"], ["box", "lite"], ["planes", "full"]]) {
  try {
    new Agent(await arkanoid.open(other), readFileSync(`${folder}/${name}.network`));
  } catch (error) {
    found[`wrong ${name}`] = error.message;
  }
}
console.log(JSON.stringify(found));
