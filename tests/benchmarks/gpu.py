"""Compares games on a graphics card with this processor's, in bits and in speed, and with peers.

Run: python tests/benchmarks/gpu.py [--device cpu] [--quick]

1. games: both play the same decisions, and every number is compared; at most 100,000 decisions of
   4,096 worlds, and for --patience seconds a game. 600 are enough for all of them on 16 cores.
2. speed: decisions per second, with random actions that are drawn before, after the games have
   drifted apart, where there is a goal.
3. training: decisions per second of the loop alone.
4. quick, lite: these agents are trained, for about 10 and 60 s on an H100, and play as `arkanoid
   evaluate` does.
5. peers: those that can be imported: gymnax, PufferLib, env-breakoutatari2600-turbo-native.
6. others: the speed of other kinds of games, and how well the packaged `lite` plays.

A ratio says how many times as fast a row is as all cores with the same games. The parts up to the
agents take an H100 less than five minutes. What fails is told, and the next part begins.
"""

import argparse
import os
import subprocess
import sys
import time
import traceback
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from importlib.metadata import version
from multiprocessing import get_context

import arkanoid  # noqa: F401
import torch
from arkanoid.envs.tensor_vector_env import read_device
from arkanoid.envs.tensors.entries import STEPS
from arkanoid.physics.kernels.portable.ptx import make_ptx
from cards.comparing import show_compared
from cards.measuring import QUICK, THOROUGH, Effort
from cards.peers import show_peers
from cards.speed import GOALS, OTHERS, show_ours
from cards.training import show_agent, show_loops, show_packaged

Part = Callable[[str, Effort], None]


def _others(device: str, effort: Effort) -> None:
    show_ours(device, OTHERS, effort)
    show_packaged(effort)


# The parts, the most important ones first, and what is printed above their rows.
PARTS: dict[str, tuple[str, Part]] = {
    "games": ("The same decisions on the device and on the processor:", show_compared),
    "speed": (
        "Decisions per second (x: times all cores with the same observations):",
        lambda device, effort: show_ours(device, GOALS, effort),
    ),
    "training": ("Training, decisions per second (x: times a core):", show_loops),
    "quick": (
        "An agent, decisions per second:",
        lambda device, effort: show_agent(device, "quick", effort),
    ),
    "lite": (
        "Another agent, decisions per second:",
        lambda device, effort: show_agent(device, "lite", effort),
    ),
    "peers": ("Peers, decisions per second:", lambda device, effort: show_peers(effort)),
    "others": ("Other games, decisions per second:", _others),
}


def prepare() -> None:
    """Compile the kernels of all kinds of observations at the same time; they are kept on disk."""
    begin = time.perf_counter()
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        entries = {kind: [run.entry for run in runs] for kind, runs in STEPS.items()}
        made = {kind: pool.submit(make_ptx, each) for kind, each in entries.items()}
        for kind, future in made.items():
            if (error := future.exception()) is not None:
                print(f"  kernels for {kind} FAILED: {error}", flush=True)
    print(f"  kernels: {time.perf_counter() - begin:.0f} s", flush=True)


def works(device: str) -> bool:
    """Tell whether a device still computes: an error in a kernel ends all further work of it."""
    try:
        return bool((torch.zeros(1, device=device) + 1).item())
    except RuntimeError:
        return False


def attempt(part: str, device: str, effort: Effort) -> bool:
    """Do a part; return False if it has failed, which is told."""
    title, show = PARTS[part]
    print(title, flush=True)
    begin = time.perf_counter()
    try:
        show(device, effort)
    except Exception as error:  # whatever fails, the other parts are worth a card's time
        print(f"  {part} FAILED: {type(error).__name__}: {error}", flush=True)
        traceback.print_exc()
        return False
    finally:
        print(f"  {part}: {time.perf_counter() - begin:.0f} s", flush=True)
    return True


def run_again(parts: list[str]) -> int:
    """Do the parts that are left in another process, with this one's other options."""
    arguments = [word for word in sys.argv[1:] if word not in ("--only", *PARTS)]
    return subprocess.run(
        [sys.executable, __file__, *arguments, "--only", *parts], check=False
    ).returncode


def show(parts: list[str], device: str, effort: Effort) -> int:
    """Do parts; return how many have failed, or at least that one has."""
    failed = 0
    for number, part in enumerate(parts, 1):
        if attempt(part, device, effort):
            continue
        failed += 1
        if parts[number:] and not works(device):
            print("The device computes no more: a new process goes on.", flush=True)
            return failed + run_again(parts[number:])
    return failed


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--device", help="of torch; a card if there is one, or else left out")
    parser.add_argument("--quick", action="store_true", help="try it out; the figures mean nothing")
    parser.add_argument("--only", choices=PARTS, nargs="+", default=PARTS, help="some of the parts")
    parser.add_argument("--patience", type=float, help="seconds to compare each of both games")
    options = parser.parse_args()
    # JAX would take most of the card's memory for itself.
    os.environ.setdefault("XLA_PYTHON_CLIENT_PREALLOCATE", "false")
    effort = QUICK if options.quick else THOROUGH
    if options.patience is not None:
        effort = replace(effort, patience=options.patience)
    device = options.device or ("cuda" if torch.cuda.is_available() else None)
    if device is None:
        print("no graphics card: --device cpu --quick tries out what a card would do")
        return
    try:
        on_card = read_device(device).type == "cuda"
    except (ImportError, RuntimeError, ValueError) as error:
        parser.error(str(error))
    card = torch.cuda.get_device_name(device) if on_card else "this processor"
    begin = time.perf_counter()
    facts = f"torch {torch.__version__}, {os.cpu_count()} cores, numba {version('numba')}"
    print(f"{card}, {facts}", flush=True)
    if on_card:
        prepare()
    failed = show([part for part in PARTS if part in options.only], device, effort)
    print(f"{time.perf_counter() - begin:.0f} s", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
