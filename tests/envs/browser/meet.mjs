// Lets pairs of bodies meet, see test_meetings.py, and prints the records.
// node meet.mjs JOBS SOURCES MODULE MANIFEST

import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [jobs, sources, module, manifest] = process.argv.slice(2);
const { loadArkanoid } = await import(pathToFileURL(`${sources}/game.js`));
const arkanoid = await loadArkanoid(
  readFileSync(module),
  JSON.parse(readFileSync(manifest, "utf8")),
);

const meeting = await arkanoid.meeting();
const { $address: address, $machine: machine } = meeting.record;
const { length } = arkanoid.manifest.records.Meeting;
const records = JSON.parse(readFileSync(jobs, "utf8")).map(([a, b]) => {
  meeting.meet(a, b);
  return {
    bytes: Buffer.from(machine.bytes(address, length)).toString("base64"),
    algorithm: meeting.algorithm,
  };
});
console.log(JSON.stringify(records));
