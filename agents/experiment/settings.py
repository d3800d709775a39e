"""What an experiment is: the settings of a training run and where they are read from.

This module is read before torch is imported, so that a misspelt key costs a moment, not seconds.
"""

import itertools
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from importlib import resources
from pathlib import Path
from typing import Any

from .schema import Settings, SettingsError, read_settings, setting

# Seeds of NumPy's legacy generator, which stable-baselines3 seeds too, end at 2**32 - 1.
_LARGEST_SEED = 2**32 - 1

# How the packaged files of experiments end.
CONFIG = ".toml"

ACTIVATIONS = ("tanh", "relu", "elu", "silu")
SCHEDULES = ("constant", "linear")
FEATURES = ("auto", "flat", "lattice", "planes", "nature")
SUITES = ("games", "training", "test", "named")
BASELINES = ("no-op", "random", "ball-follower", "planner")
BEST = ("return", "cleared", "score", "round")


@dataclass(frozen=True)
class Training(Settings):
    """How much is played and by how many."""

    worlds: int = setting(64, "worlds that are played at once", at_least=1)
    timesteps: int = setting(1_000_000, "decisions of all worlds together", at_least=1)
    torch_threads: int = setting(
        1, "threads of torch; the weights depend on it in the last bits", at_least=1
    )
    checkpoint_every: int = setting(
        100_000, "decisions between two checkpoints, from which a killed run goes on", at_least=1
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
    """What is made of an observation, and the policy's and the value function's layers upon it."""

    features: str = setting(
        "auto",
        "flat: all numbers side by side; lattice: of `vector`, the bricks through convolutions; "
        "planes: `grid` or `rgb` through convolutions; nature: `rgb` through those of Mnih et al. "
        "(2015), large and slow; "
        "auto: what suits the observation",
        choices=FEATURES,
    )
    channels: tuple[int, ...] = setting(
        (16, 32),
        "of lattice's and planes' convolutions, each of which halves the picture",
        at_least=1,
    )
    embedding: int = setting(64, "features that the convolutions end in", at_least=1)
    hidden: tuple[int, ...] = setting(
        (64, 64), "widths of the policy's layers, and of the value function's", at_least=1
    )
    activation: str = setting("tanh", "between the layers", choices=ACTIVATIONS)


@dataclass(frozen=True)
class Curriculum(Settings):
    """How episodes begin in the course of the training; at the beginning of a stage all do anew."""

    stages: tuple[float, ...] = setting(
        (), "parts of the training after which a further stage begins", above=0, at_most=1
    )
    difficulty: tuple[float, ...] = setting(
        (),
        "of generated rounds, one number a stage: worlds have from 0 to it, evenly spread",
        at_least=0,
        at_most=1,
    )
    rounds: tuple[int, ...] = setting(
        (), "one number a stage: worlds begin in rounds 1 to this one, in turn", at_least=1
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if any(later <= earlier for earlier, later in itertools.pairwise(self.stages)):
            raise SettingsError(f"'curriculum.stages' must rise, not {list(self.stages)}")
        count = len(self.stages) + 1
        for name in ("difficulty", "rounds"):
            values = getattr(self, name)
            if values and len(values) != count:
                raise SettingsError(
                    f"'curriculum.{name}' must have a number for each of the {count} stages "
                    f"('curriculum.stages' begins all but the first), not {len(values)}"
                )
        if self.stages and not (self.difficulty or self.rounds):
            raise SettingsError(
                "'curriculum.stages' needs 'curriculum.difficulty' or 'curriculum.rounds'"
            )


@dataclass(frozen=True)
class Validation(Settings):
    """Measuring the policy now and then in the training, on what it does not train on."""

    every: int = setting(0, "decisions between two measurements; 0: there are none", at_least=0)
    levels: tuple[str, ...] = setting(
        (),
        'each is played until it is cleared: names, files or seeds ("seeds:9000-9019"); none: '
        "whole games as in the training",
    )
    episodes: int = setting(20, "episodes of each level, one a seed", at_least=1)
    seed: int = setting(500_000, "the first seed", at_least=0, at_most=_LARGEST_SEED)
    best: str = setting("return", "mean that the best model has most of", choices=BEST)
    stop_at: float = setting(
        0.0, "cleared rate that ends the training; 0: none does", at_least=0, at_most=1
    )
    patience: int = setting(
        0, "measurements without a new best that end the training; 0: no number does", at_least=0
    )


@dataclass(frozen=True)
class Evaluation(Settings):
    """How a policy is measured: with the same levels and the same seeds as every other policy."""

    suites: tuple[str, ...] = setting(
        ("games",),
        "games: whole ones as in the training; and levels until they are cleared: training: those "
        "of the training; test: generated ones of test seeds; named: the named rounds",
        choices=SUITES,
    )
    episodes: int = setting(100, "whole games, one a seed", at_least=1)
    level_episodes: int = setting(10, "episodes of each level, one a seed", at_least=1)
    planner_episodes: int = setting(
        2, "of them the planner plays at the most, for it is slow", at_least=1
    )
    generated: int = setting(20, "generated levels of a suite", at_least=1)
    seed: int = setting(1_000_000, "the first seed", at_least=0, at_most=_LARGEST_SEED)
    deterministic: bool = setting(True, "take the likeliest action instead of drawing one")
    baselines: tuple[str, ...] = setting(
        BASELINES, "who else is measured; the planner in no whole games", choices=BASELINES
    )
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
    curriculum: Curriculum = field(default_factory=Curriculum)
    validation: Validation = field(default_factory=Validation)
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
        self._check_features()

    def _check_features(self) -> None:
        """Refuse features that the observation has not got the form for."""
        observation = self.env.get("observation", "vector")
        suited = {"lattice": ("vector",), "planes": ("grid", "rgb"), "nature": ("rgb",)}
        wanted = suited.get(self.network.features)
        if wanted is not None and observation not in wanted:
            raise SettingsError(
                f"'network.features' = {self.network.features!r} is for 'env.observation' = "
                f"{' or '.join(map(repr, wanted))}, not {observation!r}; 'auto' takes what suits"
            )
        if self.network.features in ("auto", "lattice", "planes") and not self.network.channels:
            raise SettingsError("'network.channels' must name at least one convolution's channels")


def load_experiment(config: str, overrides: Sequence[tuple[str, str]] = ()) -> Experiment:
    """Return the experiment of a TOML file or of a packaged config's name.

    ``overrides`` are pairs of a dotted key and the text of its value, as in
    ``[("ppo.learning_rate", "1e-3")]``. Raises `SettingsError` if the file is missing, is no TOML
    or holds a setting that is unknown or wrong.
    """
    source, table = read_toml(config)
    return read_settings(Experiment, table, source, overrides)


def seeded(experiment: Experiment, seed: int) -> Experiment:
    """Return the experiment with another first seed of its evaluation."""
    return replace(experiment, evaluation=replace(experiment.evaluation, seed=seed))


def read_toml(config: str, suffix: str = CONFIG) -> tuple[str, dict[str, Any]]:
    """Return the name, for messages, and the content of a TOML file or of a packaged one's name.

    Raises `SettingsError` if it is missing or is no TOML.
    """
    source, text = _read_config(config, suffix)
    try:
        return source, tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SettingsError(f"{source}: not a TOML file: {error}") from None


def packaged_configs(suffix: str = CONFIG) -> list[str]:
    """Return the names of the configs, or other TOML files, that come with the package."""
    files = (file.name for file in resources.files(_configs_package()).iterdir())
    names = (name.removesuffix(suffix) for name in files if name.endswith(suffix))
    # A name with a further dot in it is of another kind of file.
    return sorted(name for name in names if "." not in name)


def _read_config(config: str, suffix: str) -> tuple[str, str]:
    """Return the name of a config for messages, and its text."""
    path = Path(config)
    try:
        if config in packaged_configs(suffix) and not path.is_file():
            file = resources.files(_configs_package()) / f"{config}{suffix}"
            return f"config {config!r}", file.read_text(encoding="utf-8")
        return config, path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise SettingsError(f"{config}: not a TOML file: {error}") from None
    except OSError as error:
        names = ", ".join(packaged_configs(suffix))
        raise SettingsError(
            f"{config}: cannot be read ({error.strerror}); give the path of a TOML file or the "
            f"name of a packaged one: {names}"
        ) from None


def _configs_package() -> str:
    return f"{__name__.rsplit('.', 3)[0]}.configs"
