"""CleanRL's and LeanRL's own scripts, from a clone of theirs, with an id of this environment.

    git clone https://github.com/vwxyzjn/cleanrl
    python run_their_scripts.py cleanrl

Nothing in them has to be changed but what another version of NumPy asks for (`CHANGES`): the files
are copied, changed and run.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

LITE, PIXELS = "arkanoid:ArkanoidLite-v0", "arkanoid:ArkanoidLiteNoFrameskip-v0"
VELOCITY = "arkanoid:ArkanoidContinuous-v0"
EARLY = "--learning-starts 300 --buffer-size 2000"

# A script of a clone, the id that it trains on, and arguments for a short run.
SCRIPTS = {
    "cleanrl": [
        ("cleanrl/ppo.py", LITE, "--total-timesteps 2048"),
        ("cleanrl/dqn.py", LITE, f"--total-timesteps 1500 {EARLY}"),
        ("cleanrl/ppo_atari.py", PIXELS, "--total-timesteps 1024 --num-envs 2"),
        ("cleanrl/ppo_continuous_action.py", VELOCITY, "--total-timesteps 4096"),
        ("cleanrl/sac_continuous_action.py", VELOCITY, f"--total-timesteps 600 {EARLY}"),
    ],
    "leanrl": [
        ("leanrl/dqn.py", LITE, f"--total-timesteps 1500 {EARLY}"),
        ("leanrl/ppo_continuous_action.py", VELOCITY, "--total-timesteps 8192"),
        ("leanrl/sac_continuous_action.py", VELOCITY, f"--total-timesteps 600 {EARLY}"),
    ],
}
# What stands in a script, and what takes its place. LeanRL asks for NumPy 1, which made a number of
# an array of one.
CHANGES = {
    "leanrl/sac_continuous_action.py": [
        ('float(info["episode"]["r"])', 'float(info["episode"]["r"].item())'),
    ],
}


def run(clone: Path, script: str, name: str, arguments: str) -> str:
    """Run a script in the present folder, and return the end of what it prints."""
    text = (clone / script).read_text(encoding="utf-8")
    for old, new in CHANGES.get(script, []):
        assert old in text, f"{script} has no {old!r} any more"
        text = text.replace(old, new)
    copy = Path(Path(script).name)
    copy.write_text(text, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, copy, "--env-id", name, *arguments.split()],
        # For `cleanrl_utils`; and nothing is sent anywhere.
        env=os.environ | {"PYTHONPATH": str(clone), "WANDB_MODE": "disabled"},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise SystemExit(f"{script} fails:\n{done.stdout[-2000:]}{done.stderr[-4000:]}")
    return done.stdout


def main() -> None:
    """Run the scripts of a clone."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("clone", type=Path)
    clone = parser.parse_args().clone.resolve()
    for script, name, arguments in SCRIPTS[clone.name.lower()]:
        episodes = run(clone, script, name, arguments).count("episodic_return")
        told = f", tells of {episodes} episodes" if episodes else ""
        print(f"{script} --env-id {name}: trained{told}")


if __name__ == "__main__":
    main()
