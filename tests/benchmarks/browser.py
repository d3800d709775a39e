"""Measures the game for browsers: its size, and its decisions a second beside the processor's.

Run: python tests/benchmarks/browser.py [--seconds 2] [--rounds 3]

All play at random on one core, in turn, and begin games anew. The processor's kernels step 64
worlds in one call, and one world in a call from Python; JavaScript steps one world by a call. The
last column compares Chromium with 64 worlds.
"""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import time
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from arkanoid.agents.browser.page import make_page
from arkanoid.envs.batch.batch import Autoreset, Batch
from arkanoid.envs.browser.entries import ENTRIES
from arkanoid.envs.browser.manifest import browser_games, make_manifest
from arkanoid.envs.config import Config
from arkanoid.physics.kernels.portable.wasm import make_wasm

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from helpers.browser import DESKTOP, NAMES, run_browser, visit
from helpers.node import find_node
from helpers.repository import ROOT

SOURCES = ROOT / "envs" / "browser"
# Seconds. The fastest of so long parts counts: other programs take no part in it.
PART = 0.005
# A function of JavaScript: decisions a second of a game.
PLAY = """async (arkanoid, name, seconds) => {
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
  const parts = Array.from({ length: seconds / PART }, () => play(1000 * PART));
  return Math.max(...parts);
}"""
PROGRAM = """
import { readFileSync } from "node:fs";
const { loadArkanoid } = await import(process.argv[2]);
const [code, manifest] = process.argv.slice(3, 5).map((name) => readFileSync(name));
const arkanoid = await loadArkanoid(code, JSON.parse(manifest));
console.log(await (PLAY)(arkanoid, process.argv[5], SECONDS));
"""


def play_code() -> str:
    return PLAY.replace("PART", str(PART))


def in_node(code: bytes, manifest: str, name: str, seconds: float) -> float:
    """Return decisions a second in Node.js."""
    with tempfile.TemporaryDirectory() as folder:
        program, module, data = (Path(folder, name) for name in ("play.mjs", "module", "manifest"))
        text = PROGRAM.replace("PLAY", play_code()).replace("SECONDS", str(seconds))
        program.write_text(text, encoding="utf-8")
        module.write_bytes(code)
        data.write_text(manifest, encoding="utf-8")
        source = (SOURCES / "game.js").as_uri()
        command = [find_node(), program, source, module, data, name]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
    return float(done.stdout)


def in_chromium(page: Any, name: str, seconds: float) -> float:
    """Return decisions a second in the page that `arkanoid web` serves."""
    call = f"([name, seconds]) => ({play_code()})(arkanoid.arkanoid, name, seconds)"
    return float(page.evaluate(call, [name, seconds]))


@contextmanager
def open_page() -> Iterator[Any]:
    """Open the page in Chromium; None where there is no browser."""
    if not any(map(shutil.which, NAMES)):
        yield None
        return
    with tempfile.TemporaryDirectory() as folder, run_browser() as browser:
        file = Path(folder, "game.html")
        file.write_text(make_page([]), encoding="utf-8")
        # Its part without a picture that moves.
        with visit(browser, f"{file.as_uri()}#replay", **DESKTOP) as page:
            yield page


def here(config: Config, worlds: int, seconds: float) -> float:
    """Return decisions a second of this processor's kernels, without observations."""
    batch = Batch(worlds, config, Autoreset.NEXT_STEP, threads=1)
    batch.reset(np.ones(worlds, np.bool_), None, list(range(worlds)))
    count = 3 if config.actions == "discrete3" else 6
    actions = np.random.default_rng(1).integers(count, size=(64, worlds))
    (block,) = (block for share in batch._shares for block in share)

    def play(budget: float) -> float:
        start, decisions = time.perf_counter(), 0
        while time.perf_counter() - start < budget:
            for action in actions:
                batch.command(action)
                block.play()
            decisions += actions.size
        return decisions / (time.perf_counter() - start)

    play(0.3)
    return max(play(PART) for _ in range(round(seconds / PART)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=2.0, help="of each figure (default: 2)")
    parser.add_argument("--rounds", type=int, default=3, help="the fastest counts (default: 3)")
    arguments = parser.parse_args()
    seconds = arguments.seconds
    games = browser_games()
    code, manifest = make_wasm(ENTRIES), json.dumps(make_manifest(games))
    scripts = b"".join(file.read_bytes() for file in sorted(SOURCES.glob("*.js")))
    for name, content in (("module", code), ("manifest", manifest.encode()), ("scripts", scripts)):
        print(f"{name:10}{len(content):9,} bytes{len(zlib.compress(content, 9)):9,} compressed")
    columns = ("Node.js", "Chromium", "64 worlds", "one world", "part")
    print(f"\n{'decisions a second':20}" + "".join(f"{column:>12}" for column in columns))
    with open_page() as page:
        for name in ("full", "lite"):
            best = [0.0] * 4
            for _ in range(arguments.rounds):
                rates = (
                    in_node(code, manifest, name, seconds),
                    in_chromium(page, name, seconds) if page else 0.0,
                    here(games[name], 64, seconds),
                    here(games[name], 1, seconds),
                )
                best = [max(pair) for pair in zip(best, rates, strict=True)]
            part = (best[1] or best[0]) / best[2]
            print(f"{name:20}" + "".join(f"{rate:12,.0f}" for rate in best) + f"{part:12.2f}")


if __name__ == "__main__":
    main()
