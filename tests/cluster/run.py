"""RLlib on this environment: are its episodes right, does it learn, does it run on two nodes?

`make ray` runs it in a virtual environment of its own; it takes about ten minutes on two cores.
"""

import argparse
import os
import platform
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path

HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parent.parent / "docs" / "examples" / "peers"
PACKAGES = ("ray", "gymnasium", "torch", "numpy", "numba")


def prepare() -> None:
    """Let this process and those of Ray find what they import, and turn off Ray's reports."""
    folders = [str(HERE), str(EXAMPLES)]
    sys.path[:0] = folders
    os.environ["PYTHONPATH"] = os.pathsep.join([*folders, os.environ.get("PYTHONPATH", "")])
    os.environ["RAY_USAGE_STATS_ENABLED"] = "0"


def say(title: str, part: Callable[[], str]) -> None:
    """Run a part, and print what it returns."""
    start = time.perf_counter()
    text = part()
    print(f"\n{title} ({time.perf_counter() - start:.0f} s)")
    for line in text.splitlines():
        print(f"  {line}", flush=True)


@contextmanager
def ray_here() -> Iterator[None]:
    """Start Ray on this machine, with room for two runners on any number of cores."""
    import ray
    from rllib_ppo import ALONE

    ray.init(num_cpus=2, log_to_driver=False, **ALONE)
    try:
        yield
    finally:
        ray.shutdown()


# Each part imports what it needs only when it runs, so `--help` needs no Ray.


def episodes(decisions: int) -> None:
    """Are RLlib's episodes right?"""
    from episodes import check_episodes, check_seeds

    say("RLlib's episodes are the game's", check_episodes)
    say("Each world has a seed of its own", check_seeds)


def training(decisions: int) -> None:
    """Does a training on several processes learn, and does RLlib measure it correctly?"""
    from episodes import check_evaluation
    from learning import check_learning, train_locally

    with ray_here():
        print("\nTraining on two processes", flush=True)
        module, summary = train_locally(decisions)
        say("It has learnt", lambda: f"{summary}\n{check_learning(module)}")
        say("RLlib measures as we do", lambda: check_evaluation(module))


def nodes(decisions: int) -> None:
    """Does it run on two nodes?"""
    from nodes import check_two_nodes

    say("Two nodes on this machine", check_two_nodes)


def scaling(decisions: int) -> None:
    """How fast is it?"""
    from scaling import measure_scaling

    with ray_here():
        say("Decisions a second", measure_scaling)


PARTS = {part.__name__: part for part in (episodes, training, nodes, scaling)}


def main() -> None:
    """Run all parts, or those that are named."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("parts", nargs="*", metavar="PART", help=f"of {', '.join(PARTS)}")
    parser.add_argument("--decisions", type=int, default=300_000, help="length of the training")
    arguments = parser.parse_args()
    unknown = [part for part in arguments.parts if part not in PARTS]
    if unknown:
        parser.error(f"there is no part {unknown[0]!r}; there are {', '.join(PARTS)}")
    prepare()
    versions = ", ".join(f"{name} {version(name)}" for name in PACKAGES)
    print(f"{platform.machine()}, Python {platform.python_version()}, {versions}")
    import torch

    torch.set_num_threads(1)  # networks of this size are faster on one
    for part in arguments.parts or PARTS:
        PARTS[part](arguments.decisions)
    print("\nAll is as it should be.")


if __name__ == "__main__":
    main()
