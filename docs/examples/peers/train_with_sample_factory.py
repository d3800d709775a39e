"""Sample-Factory: APPO on single games, with continuous actions, as its examples do.

Version 2.1 wants Gymnasium 0.29 and NumPy 1; installed with `--no-deps` it works with NumPy up to
2.3, too. Its default agent acts beyond the bounds, which counts as at them.
"""

import tempfile

import gymnasium as gym
from sample_factory.algo.utils.misc import ExperimentStatus
from sample_factory.cfg.arguments import parse_full_cfg, parse_sf_args
from sample_factory.envs.env_utils import register_env
from sample_factory.train import run_rl

SETTINGS = {
    "env": "arkanoid:ArkanoidContinuous-v0",
    "experiment": "arkanoid",
    "device": "cpu",
    "serial_mode": True,
    "async_rl": False,
    "num_workers": 1,
    "num_envs_per_worker": 8,
    "worker_num_splits": 1,
    "rollout": 32,
    "batch_size": 256,
    "num_batches_per_epoch": 1,
    "train_for_env_steps": 2048,
    "use_rnn": False,
    "max_policy_lag": 10_000,
}


def make(name: str, *_: object, render_mode: str | None = None) -> gym.Env:
    """Return a game of one life."""
    return gym.make(name, render_mode=render_mode, lives=1)


def main() -> None:
    """Train a little."""
    register_env(str(SETTINGS["env"]), make)
    arguments = [f"--{name}={value}" for name, value in SETTINGS.items()]
    arguments += ["--encoder_mlp_layers", "64", "64", "--train_dir", tempfile.mkdtemp()]
    parser, _ = parse_sf_args(arguments)
    status = run_rl(parse_full_cfg(parser, arguments))
    assert status == ExperimentStatus.SUCCESS
    print(f"trained: {SETTINGS['train_for_env_steps']} steps of {SETTINGS['env']}")


if __name__ == "__main__":
    main()
