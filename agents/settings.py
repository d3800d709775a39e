"""What an experiment is: the settings of a training run and where they are read from.

This module is read before torch is imported, so that a misspelt key costs a moment, not seconds.
"""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Any

from .schema import Settings, SettingsError, read_settings, setting

# Seeds of NumPy's legacy generator, which stable-baselines3 seeds too, end at 2**32 - 1.
_LARGEST_SEED = 2**32 - 1

ACTIVATIONS = ("tanh", "relu", "elu", "silu")
SCHEDULES = ("constant", "linear")


@dataclass(frozen=True)
class Training(Settings):
    """How much is played and by how many."""

    worlds: int = setting(64, "worlds that are played at once", at_least=1)
    timesteps: int = setting(1_000_000, "decisions of all worlds together", at_least=1)
    torch_threads: int = setting(
        1, "threads of torch; the weights depend on it in the last bits", at_least=1
    )


@dataclass(frozen=True)
class Ppo(Settings):
    """Hyper-parameters of proximal policy optimisation, named as in stable-baselines3."""

    learning_rate: float = setting(3e-4, "Adam's step size", above=0)
    schedule: str = setting("constant", "learning rate and clip range over time", choices=SCHEDULES)
    n_steps: int = setting(128, "decisions of each world between two updates", at_least=1)
    batch_size: int = setting(1024, "decisions in one gradient step", at_least=2)
    n_epochs: int = setting(4, "passes over the collected decisions in one update", at_least=1)
    gamma: float = setting(0.99, "discount factor a decision", at_least=0, at_most=1)
    gae_lambda: float = setting(0.95, "of generalised advantage estimation", at_least=0, at_most=1)
    clip_range: float = setting(0.2, "how far one update may move a probability's ratio", above=0)
    ent_coef: float = setting(0.0, "weight of the entropy bonus", at_least=0)
    vf_coef: float = setting(0.5, "weight of the value function's loss", at_least=0)
    max_grad_norm: float = setting(0.5, "gradients are clipped to this norm", above=0)


@dataclass(frozen=True)
class Network(Settings):
    """The policy's network and the value function's: equal ones, side by side."""

    hidden: tuple[int, ...] = setting((64, 64), "widths of the hidden layers", at_least=1)
    activation: str = setting("tanh", "between the layers", choices=ACTIVATIONS)


@dataclass(frozen=True)
class Evaluation(Settings):
    """How a policy is measured: one episode a seed, the same seeds for every policy."""

    episodes: int = setting(100, "episodes, one a seed", at_least=1)
    seed: int = setting(1_000_000, "the first seed", at_least=0, at_most=_LARGEST_SEED)
    deterministic: bool = setting(True, "take the likeliest action instead of drawing one")
    clip_seconds: float = setting(20.0, "length of the recorded clip, in game time", above=0)


@dataclass(frozen=True)
class Experiment(Settings):
    """One training run: everything that decides its outcome, and where it goes."""

    name: str = setting("experiment", "begins the name of the run's folder")
    seed: int = setting(0, "of weights, actions and worlds", at_least=0, at_most=_LARGEST_SEED)
    output: str = setting("runs", "the folder that gets the run's folder")
    env_id: str = setting("Arkanoid-v0", "a Gymnasium environment with a native vector version")
    env: dict[str, Any] = field(
        default_factory=dict,
        metadata={"meaning": "a keyword argument of the environment, passed on as it is"},
    )
    training: Training = field(default_factory=Training)
    ppo: Ppo = field(default_factory=Ppo)
    network: Network = field(default_factory=Network)
    evaluation: Evaluation = field(default_factory=Evaluation)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.name or not set(self.name).isdisjoint('/\\:*?"<>|'):
            raise SettingsError(f"'name' becomes a folder's name, and {self.name!r} cannot be one")
        if not self.output:
            raise SettingsError("'output' must name a folder ('.' is the current one)")
        collected = self.ppo.n_steps * self.training.worlds
        if collected % self.ppo.batch_size:
            raise SettingsError(
                f"'ppo.batch_size' ({self.ppo.batch_size}) must divide the decisions between two "
                f"updates, 'ppo.n_steps' ({self.ppo.n_steps}) times 'training.worlds' "
                f"({self.training.worlds}) = {collected}"
            )


def load_experiment(config: str, overrides: Sequence[tuple[str, str]] = ()) -> Experiment:
    """Return the experiment of a TOML file or of a packaged config's name.

    ``overrides`` are pairs of a dotted key and the text of its value, as in
    ``[("ppo.learning_rate", "1e-3")]``. Raises `SettingsError` if the file is missing, is no TOML
    or holds a setting that is unknown or wrong.
    """
    source, text = _read_config(config)
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SettingsError(f"{source}: not a TOML file: {error}") from None
    return read_settings(Experiment, table, source, overrides)


def packaged_configs() -> list[str]:
    """Return the names of the configs that come with the package."""
    files = resources.files(_configs_package()).iterdir()
    return sorted(file.name.removesuffix(".toml") for file in files if file.name.endswith(".toml"))


def _read_config(config: str) -> tuple[str, str]:
    """Return the name of a config for messages, and its text."""
    path = Path(config)
    try:
        if config in packaged_configs() and not path.is_file():
            file = resources.files(_configs_package()) / f"{config}.toml"
            return f"config {config!r}", file.read_text(encoding="utf-8")
        return config, path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise SettingsError(f"{config}: not a TOML file: {error}") from None
    except OSError as error:
        names = ", ".join(packaged_configs())
        raise SettingsError(
            f"{config}: cannot be read ({error.strerror}); give the path of a TOML file or the "
            f"name of a packaged config: {names}"
        ) from None


def _configs_package() -> str:
    return f"{__package__.rpartition('.')[0]}.configs"
