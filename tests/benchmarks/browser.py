"""Measures the game for browsers: its size, and its decisions a second beside the processor's.

Run: python tests/benchmarks/browser.py [--seconds 2]

Both play at random on one core, and begin games anew. The processor's kernels step 64 worlds in one
call, and one world in a call from Python; JavaScript steps one world by a call.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
import zlib
from pathlib import Path

import numpy as np
from arkanoid.envs.batch.batch import Autoreset, Batch
from arkanoid.envs.browser.entries import ENTRIES
from arkanoid.envs.browser.manifest import browser_games, make_manifest
from arkanoid.envs.config import Config
from arkanoid.physics.kernels.portable.wasm import make_wasm

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from helpers.node import find_node
from helpers.repository import ROOT

SOURCES = ROOT / "envs" / "browser"
PROGRAM = """
import { readFileSync } from "node:fs";
const { loadArkanoid } = await import(process.argv[2]);
const [code, manifest] = process.argv.slice(3).map((name) => readFileSync(name));
const arkanoid = await loadArkanoid(code, JSON.parse(manifest));
const rates = {};
for (const name of ["full", "lite"]) {
  const game = await arkanoid.open(name);
  game.reset({ seed: 1 });
  const { length } = game.commands;
  const actions = Array.from({ length: 4096 }, () => Math.floor(Math.random() * length));
  const play = (milliseconds) => {
    const start = performance.now();
    let decisions = 0;
    while (performance.now() - start < milliseconds) {
      for (const action of actions) {
        if (game.over) game.reset();
        game.step(action);
      }
      decisions += actions.length;
    }
    return decisions / (performance.now() - start) * 1000;
  };
  play(300);
  rates[name] = play(SECONDS * 1000);
}
console.log(JSON.stringify(rates));
"""


def in_node(code: bytes, manifest: str, seconds: float) -> dict[str, float]:
    """Return decisions a second of each game."""
    with tempfile.TemporaryDirectory() as folder:
        program, module, data = (Path(folder, name) for name in ("play.mjs", "module", "manifest"))
        program.write_text(PROGRAM.replace("SECONDS", str(seconds)), encoding="utf-8")
        module.write_bytes(code)
        data.write_text(manifest, encoding="utf-8")
        source = (SOURCES / "game.js").as_uri()
        command = [find_node(), program, source, module, data]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    rates: dict[str, float] = json.loads(done.stdout)
    return rates


def here(config: Config, worlds: int, seconds: float) -> float:
    """Return decisions a second of this processor's kernels, without observations."""
    batch = Batch(worlds, config, Autoreset.NEXT_STEP, threads=1)
    batch.reset(np.ones(worlds, np.bool_), None, list(range(worlds)))
    count = 3 if config.actions == "discrete3" else 6
    actions = np.random.default_rng(1).integers(count, size=(64, worlds))
    (block,) = (block for share in batch._shares for block in share)
    rate, budget = 0.0, 0.3
    for _ in range(2):  # at first to warm up
        start, decisions = time.perf_counter(), 0
        while time.perf_counter() - start < budget:
            for action in actions:
                batch.command(action)
                block.play()
            decisions += actions.size
        rate, budget = decisions / (time.perf_counter() - start), seconds
    return rate


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=2.0, help="of each figure (default: 2)")
    seconds = parser.parse_args().seconds
    games = browser_games()
    code, manifest = make_wasm(ENTRIES), json.dumps(make_manifest(games))
    scripts = b"".join(file.read_bytes() for file in sorted(SOURCES.glob("*.js")))
    for name, content in (("module", code), ("manifest", manifest.encode()), ("scripts", scripts)):
        print(f"{name:10}{len(content):9,} bytes{len(zlib.compress(content, 9)):9,} compressed")
    rates = in_node(code, manifest, seconds)
    print(
        f"\n{'decisions a second':20}{'Node.js':>12}{'64 worlds':>12}{'one world':>12}{'part':>8}"
    )
    for name, rate in rates.items():
        many, one = here(games[name], 64, seconds), here(games[name], 1, seconds)
        print(f"{name:20}{rate:12,.0f}{many:12,.0f}{one:12,.0f}{rate / many:8.2f}", flush=True)


if __name__ == "__main__":
    main()
