// Lets agents play, and prints what they saw and said.
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
  game.reset({ seed: 5 });
  const seen = [];
  const said = [];
  let action = 0;
  for (let decision = 0; decision < decisions; decision++) {
    // By tick, an action is held as long as the agent knows it.
    if (!played.includes("tick") || game.world.decisions % agent.config.frame_skip === 0) {
      const judged = agent.judge();
      ({ action } = judged);
      seen.push(...game.vector());
      said.push(action, judged.value, ...judged.probabilities);
    }
    game.step(action);
    if (game.over) game.reset();
  }
  writeFileSync(`${folder}/${name} ${played}.seen`, new Float32Array(seen));
  writeFileSync(`${folder}/${name} ${played}.said`, new Float64Array(said));
  found[`${name} ${played}`] = game.info;
}
const wrong = await arkanoid.open("full");
try {
  new Agent(wrong, readFileSync(`${folder}/lite.network`));
} catch (error) {
  found.wrong = error.message;
}
console.log(JSON.stringify(found));
