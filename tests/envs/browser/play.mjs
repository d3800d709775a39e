// Does the jobs of a file, see test_same_bits.py, and prints what came of them.
// node play.mjs JOBS SOURCES MODULE MANIFEST

import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [jobs, sources, module, manifest] = process.argv.slice(2);
const source = (name) => import(pathToFileURL(`${sources}/${name}`));
const { loadArkanoid } = await source("game.js");
const { Ears } = await source("hearing.js");
const { Recorder, Replay } = await source("replay.js");
const arkanoid = await loadArkanoid(
  readFileSync(module),
  JSON.parse(readFileSync(manifest, "utf8")),
);

const bytes = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);

/** Return the error that a function throws, as text. */
async function thrown(act) {
  try {
    await act();
  } catch (error) {
    return error.message;
  }
  return "";
}

const works = {
  /** Play actions, and digest states, observations and pictures after each part of them. */
  async play({ game: name, reset, actions, part, observeEvery, drawEvery, sizes }) {
    const game = await arkanoid.open(name);
    game.reset(reset);
    const kinds = ["state", "vector", "grid", "picture"];
    let hashes;
    const digests = [];
    actions.forEach((action, decision) => {
      if (decision % part === 0) {
        hashes = Object.fromEntries(kinds.map((kind) => [kind, createHash("sha256")]));
      }
      if (game.over) game.reset();
      game.step(action);
      hashes.state.update(game.save());
      if (decision % observeEvery === 0) {
        hashes.vector.update(bytes(game.vector()));
        hashes.grid.update(bytes(game.grid()));
      }
      if (decision % drawEvery === 0) {
        for (const [height, width, channels] of sizes) {
          hashes.picture.update(game.draw(width, height, channels));
        }
      }
      if ((decision + 1) % part === 0) {
        digests.push(kinds.map((kind) => hashes[kind].digest("hex")));
      }
    });
    return digests;
  },

  /** Play a recorded game again, and write it anew. */
  async replay({ file }) {
    const tools = await arkanoid.open("full");
    const replay = await Replay.fromBytes(Buffer.from(file, "base64"), tools);
    const game = await replay.open(arkanoid);
    const digest = createHash("sha256");
    for (const _ of replay.play(game)) digest.update(game.save());
    const again = Buffer.from(await replay.toBytes(tools)).toString("base64");
    return { digest: digest.digest("hex"), again, game: game.name };
  },

  /** Open games with other rules, and return these. */
  async rules({ games }) {
    const found = [];
    for (const [config, levels] of games) {
      const { machine, address } = await arkanoid.openAs(config, levels).then((game) => ({
        machine: game.machine,
        address: game.address("rules"),
      }));
      const { length } = arkanoid.manifest.records.Rules;
      found.push(Buffer.from(machine.bytes(address, length)).toString("base64"));
    }
    return found;
  },

  /** Play and record a game. */
  async record({ game: name, reset, actions }) {
    const game = await arkanoid.open(name);
    const recorder = new Recorder(game);
    recorder.reset(reset);
    actions.forEach((action) => recorder.step(action));
    return Buffer.from(await recorder.replay().toBytes(game)).toString("base64");
  },

  /** Generate levels. */
  async generate({ levels }) {
    const board = await arkanoid.board();
    return levels.map(({ seed, difficulty, recipe }) =>
      board.generate(BigInt(seed), difficulty, recipe),
    );
  },

  /** Search layouts for bricks that can't be reached. */
  async search({ layouts }) {
    const board = await arkanoid.board();
    return layouts.map((bricks) => {
      board.bricks = bricks;
      return board.search();
    });
  },

  /** Go back to a saved state, and play on as before. */
  async restore({ game: name, actions }) {
    const game = await arkanoid.open(name);
    game.reset({ seed: 1 });
    const half = actions.length / 2;
    actions.slice(0, half).forEach((action) => game.step(action));
    const saved = game.save();
    const onward = () => {
      const seen = createHash("sha256");
      for (const action of actions.slice(half)) {
        game.step(action);
        for (const array of [game.save(), bytes(game.vector()), bytes(game.grid())]) {
          seen.update(array);
        }
      }
      return seen.digest("hex");
    };
    const first = onward();
    game.restore(saved);
    return [first, onward()];
  },

  /** Return the tones of each tick. */
  async hear({ game: name, actions }) {
    const game = await arkanoid.open(name);
    game.reset({ seed: 4 });
    const ears = new Ears(game);
    return actions.map((action) => {
      if (game.over) game.reset();
      ears.listen();
      game.step(action);
      return ears.hear();
    });
  },

  /** Draw in many sizes, as a page that is resized does, and return how memory grows. */
  async resize({ sizes }) {
    const game = await arkanoid.open("full");
    game.reset({ seed: 1 });
    const grown = [];
    let drawn;
    for (let time = 0; time < 2; time++) {
      for (const [height, width] of sizes) drawn = game.draw(width, height);
      grown.push(game.machine.memory.buffer.byteLength);
    }
    return { grown, digest: createHash("sha256").update(drawn).digest("hex") };
  },

  /** Read numbers of a game by their names. */
  async names() {
    const game = await arkanoid.open("full");
    game.reset({ seed: 3, level: "spiral" });
    for (let decision = 0; decision < 60; decision++) game.step([decision % 3 - 1, 1]);
    // JSON has no BigInts.
    const plain = (key, value) => (typeof value === "bigint" ? String(value) : value);
    const world = JSON.parse(JSON.stringify(game.world.plain(), plain));
    return { world, info: game.info };
  },

  /** Make mistakes. */
  async mistakes(job) {
    const game = await arkanoid.open("lite");
    const tools = await arkanoid.open("full");
    const replay = await new Recorder(tools);
    replay.reset({ seed: 1 });
    const file = await replay.replay().toBytes(tools);
    const damaged = file.slice();
    damaged[40] ^= 1;
    const first = await thrown(() => game.reset());
    game.reset({ seed: 1 });
    const { plain, plan } = job;
    const other = await arkanoid.openAs(plain, plan);
    const acts = {
      paddle: () => arkanoid.openAs({ ...plain, paddle: 6 }, plan),
      ticks: () => arkanoid.openAs({ ...plain, frame_skip: 0 }, plan),
      unseen: () => other.vector(),
      game: () => arkanoid.open("chess"),
      number: () => game.step(3),
      fraction: () => game.step(0.5),
      velocity: () => game.step([NaN, 0]),
      level: () => game.reset({ level: "nowhere" }),
      brick: () => game.reset({ bricks: "ww?" }),
      boss: () => game.reset({ level: "warden" }),
      state: () => game.restore(new Uint8Array(3)),
      nothing: () => Replay.fromBytes(new Uint8Array(3), tools),
      damaged: () => Replay.fromBytes(damaged, tools),
      early: () => new Recorder(game).step(0),
    };
    const found = { first };
    for (const [name, act] of Object.entries(acts)) found[name] = await thrown(act);
    return found;
  },
};

const results = {};
for (const [name, job] of Object.entries(JSON.parse(readFileSync(jobs, "utf8")))) {
  results[name] = await works[job.work](job);
}
console.log(JSON.stringify(results));
