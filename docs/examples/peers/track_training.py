"""Trackers: `arkanoid train` writes a run for MLflow and for Weights & Biases, without a network.

The settings are those of a training that takes a second.
"""

import subprocess
import sys
from pathlib import Path

import mlflow

SETTINGS = {
    "training.timesteps": "4096",
    "training.worlds": "8",
    "ppo.n_steps": "64",
    "ppo.batch_size": "128",
    "evaluation.episodes": "2",
    "evaluation.baselines": "[]",
    "evaluation.film_seconds": "0.5",
}


def main() -> None:
    """Train, and read what both trackers were told."""
    settings = [f"--{key}={value}" for key, value in SETTINGS.items()]
    trackers = ["--track", "mlflow", "--track", "wandb"]
    command = [sys.executable, "-m", "arkanoid", "train", "quick", *settings, *trackers]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    (run,) = Path("runs").iterdir()

    database = (run / "mlflow" / "mlflow.db").resolve()
    client = mlflow.MlflowClient(tracking_uri=f"sqlite:///{database.as_posix()}")
    experiment = client.get_experiment_by_name("arkanoid")
    (tracked,) = client.search_runs([experiment.experiment_id])
    assert tracked.data.params["ppo.n_steps"] == "64"
    assert "evaluation/games/score" in tracked.data.metrics
    returns = client.get_metric_history(tracked.info.run_id, "rollout/ep_rew_mean")
    (model,) = client.list_artifacts(tracked.info.run_id, "model")
    points = [point.step for point in returns]
    print(f"MLflow: {tracked.info.status}, returns after {points} decisions, {model.path}")

    (kept,) = (run / "wandb").glob("offline-run-*/*.wandb")
    assert b"evaluation/games/score" in kept.read_bytes()
    print("Weights & Biases: a run offline, with curves, settings, evaluation and model")


if __name__ == "__main__":
    main()
