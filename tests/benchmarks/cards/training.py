"""Training on a card: how fast it is, and how well the agents play that come out of it."""

import tempfile
import time
from collections.abc import Callable

from arkanoid.agents.experiment.runs import ModelFile, RunFolder
from arkanoid.agents.experiment.settings import Experiment, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.learn.model import load_policy, make_model
from arkanoid.agents.learn.training import train
from arkanoid.agents.measure.comparison import compare
from arkanoid.agents.measure.episodes import adapt
from stable_baselines3.common.callbacks import BaseCallback

from .measuring import Effort, say, verdict, waiting

# Worlds and the size of minibatches.
LOOPS = ((16384, 65536), (4096, 16384))
ON_A_CORE, SMALL = (512, 4096), (32, 256)
LEAST_SPEED = 3_000_000  # decisions a second
# Trained with the last of them: decisions, the most seconds, and what the agent of the same name in
# docs/results reaches in a suite.
TRAINED = {
    "quick": (24_000_000, 10.0, ("games", "hits", 531.0)),
    "lite": (140_000_000, 60.0, ("named", "cleared", 0.98)),
}


class Clock(BaseCallback):
    """Notes when rollouts begin, and ends the training after some of them."""

    def __init__(self, rollouts: int, wait: Callable[[], None]) -> None:
        super().__init__()
        self.rollouts, self.wait = rollouts, wait
        self.times: list[float] = []

    def _on_rollout_start(self) -> None:
        self.wait()
        self.times.append(time.perf_counter())

    def _on_step(self) -> bool:
        return len(self.times) <= self.rollouts


def settings(device: str, config: str, worlds: int, batch: int, **others: str) -> Experiment:
    """Return an experiment with its network on a device."""
    changes = {"training.device": device.partition(":")[0], "training.worlds": str(worlds)}
    changes |= {"ppo.batch_size": str(batch), "validation.every": "0", **others}
    return load_experiment(config, list(changes.items()))


def measure_loop(device: str | None, worlds: int, batch: int, effort: Effort) -> float:
    """Return the decisions per second of training `quick`; with None, on a core and with arrays."""
    experiment = settings(device or "cpu", "quick", worlds, batch)
    venv = adapt(make_worlds(experiment, worlds, device=device))
    model = make_model(experiment, venv)
    first = 5  # later ones are replayed by the card
    clock = Clock(first + (40 if effort.training == 1 else 2), waiting(device))
    model.learn(10**9, clock)
    venv.close()
    seconds = clock.times[-1] - clock.times[first]
    return (len(clock.times) - 1 - first) * worlds * model.n_steps / seconds


def show_loops(device: str, effort: Effort) -> None:
    """Print how fast the loop is."""
    small = effort.training > 1
    here, *there = [SMALL] * 2 if small else [ON_A_CORE, *LOOPS]
    core = measure_loop(None, *here, effort)
    say(f"loop of quick, {here[0]:,} worlds, a core", f"{core:14,.0f}")
    best = 0.0
    for worlds, batch in there:
        found = measure_loop(device, worlds, batch, effort)
        best = max(best, found)
        say(f"loop of quick, {worlds:,} worlds, {device}", f"{found:14,.0f}{found / core:9.2f} x")
    verdict(effort, f"{LEAST_SPEED:,} a second", best >= LEAST_SPEED)


def show_packaged(effort: Effort) -> None:
    """Print how well the agent in the package plays."""
    show_played("packaged lite", ModelFile.find("lite", False), small_games(effort))


def small_games(effort: Effort) -> list[tuple[str, str]]:
    """Return the settings of an evaluation: the agent alone plays."""
    games = [("evaluation.baselines", "[]"), ("evaluation.film_seconds", "0.1")]
    few = [("evaluation.episodes", "2"), ("evaluation.level_episodes", "1")]
    return games + ([*few, ("env.max_decisions", "60")] if effort.training > 1 else [])


def show_agent(device: str, config: str, effort: Effort) -> None:
    """Train an agent as `arkanoid train` does, and print how well it plays."""
    decisions, most_seconds, (suite, measure, least) = TRAINED[config]
    decisions //= effort.training
    with tempfile.TemporaryDirectory() as output:
        more = {"training.timesteps": str(decisions), "output": output}
        more["evaluation.suites"] = f'["{suite}"]'
        sizes = SMALL if effort.training > 1 else LOOPS[-1]
        experiment = settings(device, config, *sizes, **more, **dict(small_games(effort)))
        folder = RunFolder.create(experiment)
        begin = time.perf_counter()
        train(experiment, folder, shows_progress=False)
        seconds = time.perf_counter() - begin
        say(
            f"{config}, {decisions:,} decisions",
            f"{decisions / seconds:14,.0f}  in {seconds:.1f} s",
        )
        played = show_played(config, ModelFile.find(str(folder.path), False), [])
    met = seconds <= most_seconds and played[suite][measure] >= least
    verdict(effort, f"{measure} of {suite} {least:g} in {most_seconds:g} s", met)


def show_played(
    label: str, model: ModelFile, overrides: list[tuple[str, str]]
) -> dict[str, dict[str, float]]:
    """Print how well a model plays: means over the episodes of each suite, which it returns."""
    experiment = model.experiment(overrides)
    played = compare(experiment, {"agent": [load_policy(model, experiment)]})
    means: dict[str, dict[str, float]] = {}
    for suite, results in played.items():
        means[suite] = {name: float(found.mean()) for name, found in results["agent"].items()}
        hits, cleared, gain = (means[suite][name] for name in ("hits", "cleared", "return"))
        told = f"{hits:14.1f}{cleared:6.2f}{gain:7.2f}"
        say(f"{label} plays {suite}: hits, cleared, return", told)
    return means
