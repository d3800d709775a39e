// Runs entries of a module, and prints the memory that they worked on.
// node run.mjs JOBS MODULE

import { readFileSync } from "node:fs";

const [jobs, module] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(readFileSync(module), {});
const { memory, ...entries } = instance.exports;
const first = memory.buffer.byteLength;
memory.grow(1);
const results = JSON.parse(readFileSync(jobs, "utf8")).map(({ entry, index, numbers, integers }) => {
  const found = integers ? new BigInt64Array(memory.buffer, first, 4) : new Float64Array(memory.buffer, first, 4);
  found.set(integers ? numbers.map(BigInt) : numbers);
  entries[entry](index, first);
  return Array.from(found, Number);
});
console.log(JSON.stringify({ results, exports: Object.keys(instance.exports), first }));
