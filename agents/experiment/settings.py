"""What an experiment is: the settings of a training run.

They are read before torch is imported, so that a misspelt key costs a moment and not seconds.
"""

import itertools
from collections.abc import Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Annotated, Any, Literal, get_args

import gymnasium as gym
from pydantic import ConfigDict, Field, Strict
from pydantic.dataclasses import dataclass

from ...envs.config import Config
from ...envs.registration import resolve_config
from .errors import SettingsError
from .reading import read_settings, read_toml

# NumPy's legacy generator, which stable-baselines3 seeds, takes seeds up to 2**32 - 1.
_LARGEST_SEED = 2**32 - 1
# Far beyond what anyone needs, and still within what counters and arrays can hold. A typing error
# gets a sentence, and no file from somebody else can ask for all of the memory.
_MANY = 1_000_000
_MOST_DECISIONS = 10**15
_WIDEST = 16_384
_DEEPEST = 32
_MOST_THREADS = 1024

_CHECKED = ConfigDict(extra="forbid", allow_inf_nan=False)

# TOML keeps these kinds apart; without `Strict` pydantic would take one for another.
Integer = Annotated[int, Strict()]
Number = Annotated[float, Strict()]
Switch = Annotated[bool, Strict()]

Count = Annotated[Integer, Field(ge=1, le=_MANY)]
Decisions = Annotated[Integer, Field(ge=1, le=_MOST_DECISIONS)]
Width = Annotated[Integer, Field(ge=1, le=_WIDEST)]
Seed = Annotated[Integer, Field(ge=0, le=_LARGEST_SEED)]
Positive = Annotated[Number, Field(gt=0)]
NotNegative = Annotated[Number, Field(ge=0)]
Fraction = Annotated[Number, Field(ge=0, le=1)]
PositiveFraction = Annotated[Number, Field(gt=0, le=1)]

SuiteName = Literal["games", "training", "test", "named"]
BaselineName = Literal["no-op", "random", "ball-follower", "landing-follower", "planner"]
BestMeasure = Literal["return", "cleared", "score", "round"]
BASELINES: tuple[BaselineName, ...] = get_args(BaselineName)
BEST: tuple[BestMeasure, ...] = get_args(BestMeasure)


@dataclass(frozen=True, config=_CHECKED)
class Training:
    """How much is played and by how many."""

    worlds: Count = Field(default=64, description="worlds that are played at once")
    timesteps: Decisions = Field(default=1_000_000, description="decisions of all worlds together")
    trainer: Literal["fast", "sb3"] = Field(
        default="fast",
        description="fast: the loops of `FastPPO`; sb3: those of stable-baselines3; other weights",
    )
    device: Literal["cpu", "cuda", "auto"] = Field(
        default="cpu",
        description="where the network computes and, on cuda, games are played; auto: cuda if it "
        "is there. A graphics card pays for pictures and for thousands of worlds",
    )
    torch_threads: Annotated[Integer, Field(ge=1, le=_MOST_THREADS)] = Field(
        default=1, description="threads of torch; the weights' last bits depend on it"
    )
    checkpoint_every: Decisions = Field(
        default=100_000,
        description="decisions between two checkpoints, from which a killed run resumes",
    )


@dataclass(frozen=True, config=_CHECKED)
class Ppo:
    """Hyper-parameters of proximal policy optimisation, named as in stable-baselines3."""

    learning_rate: Positive = Field(default=3e-4, description="Adam's step size")
    schedule: Literal["constant", "linear"] = Field(
        default="constant",
        description="learning rate and clip range over time; linear: they fall to 0",
    )
    n_steps: Count = Field(default=128, description="decisions of each world between two updates")
    batch_size: Annotated[Integer, Field(ge=2, le=_MOST_DECISIONS)] = Field(
        default=1024, description="decisions in one gradient step"
    )
    n_epochs: Count = Field(
        default=4, description="passes over the collected decisions in one update"
    )
    gamma: Fraction = Field(default=0.99, description="discount factor per decision")
    gae_lambda: Fraction = Field(
        default=0.95, description="lambda of generalised advantage estimation"
    )
    clip_range: Positive = Field(
        default=0.2, description="how far one update may move the ratio of two probabilities"
    )
    ent_coef: NotNegative = Field(default=0.0, description="weight of the entropy bonus")
    vf_coef: NotNegative = Field(default=0.5, description="weight of the value function's loss")
    max_grad_norm: Positive = Field(default=0.5, description="gradients are clipped to this norm")


@dataclass(frozen=True, config=_CHECKED)
class Network:
    """Which features are made of an observation, and the layers above them."""

    features: Literal["auto", "flat", "landing", "lattice", "planes", "nature"] = Field(
        default="auto",
        description="flat: all numbers side by side; landing: these, and where and when the balls "
        "of `vector` come down among the walls alone; lattice: the bricks of `vector` through "
        "convolutions; planes: `grid` or `rgb` through convolutions; nature: `rgb` through those "
        "of Mnih et al. (2015), large and slow; auto: what suits the observation",
    )
    channels: tuple[Width, ...] = Field(
        default=(16, 32),
        description="of the convolutions of lattice and planes; each halves the picture",
    )
    embedding: Width = Field(default=64, description="features that the convolutions return")
    hidden: tuple[Width, ...] = Field(
        default=(64, 64), description="widths of the policy's layers, and of the value function's"
    )
    activation: Literal["tanh", "relu", "elu", "silu"] = Field(
        default="tanh", description="function between the layers"
    )

    def __post_init__(self) -> None:
        for name in ("channels", "hidden"):
            layers = len(getattr(self, name))
            if layers > _DEEPEST:
                raise SettingsError(
                    f"'network.{name}' must have at most {_DEEPEST} layers, not {layers}"
                )


@dataclass(frozen=True, config=_CHECKED)
class Imitation:
    """Behaviour cloning before PPO begins: policy and value function learn from recorded games."""

    dataset: str = Field(
        default="",
        description="Minari data set that is imitated: its id, or its folder; empty: none",
    )
    epochs: Count = Field(default=10, description="passes over the data set")
    batch_size: Count = Field(default=512, description="decisions in one gradient step")
    learning_rate: Positive = Field(default=1e-3, description="Adam's step size")


@dataclass(frozen=True, config=_CHECKED)
class Curriculum:
    """How episodes begin in each stage of a training; a stage begins with new episodes."""

    stages: tuple[PositiveFraction, ...] = Field(
        default=(), description="parts of the training after which a further stage begins"
    )
    difficulty: tuple[Fraction, ...] = Field(
        default=(),
        description="of generated levels, one number per stage; the worlds' difficulties are "
        "evenly spread from 0 to it",
    )
    rounds: tuple[Count, ...] = Field(
        default=(),
        description="one number per stage; worlds begin in rounds 1 to this one, in turn",
    )
    sampling: Literal["uniform", "value_loss", "positive_value_loss"] = Field(
        default="uniform",
        description="which level is played next: any, or again one where the advantages were large "
        "(prioritised level replay): their magnitudes, or their positive parts",
    )
    new_levels: Fraction = Field(
        default=0.5, description="part of the levels that is drawn as without replay"
    )
    temperature: Positive = Field(
        default=1.0, description="of replay: probabilities are ranks ** (-1 / temperature)"
    )
    staleness: Fraction = Field(
        default=0.1, description="part of replay that goes to levels not played for long"
    )
    kept_levels: Count = Field(default=1000, description="levels among which replay chooses")

    def __post_init__(self) -> None:
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


@dataclass(frozen=True, config=_CHECKED)
class Validation:
    """Regular measurements during the training, on episodes that it does not train on."""

    every: Annotated[Integer, Field(ge=0)] = Field(
        default=0, description="decisions between two measurements; 0: no validation"
    )
    levels: tuple[str, ...] = Field(
        default=(),
        description='each is played until it is cleared: names, "named" for all named levels, '
        'files or seeds ("seeds:9000-9019"); without any: whole games as in the training',
    )
    episodes: Count = Field(default=20, description="episodes of each level, one per seed")
    seed: Seed = Field(default=500_000, description="spread over the episodes")
    best: BestMeasure = Field(
        default="return", description="the best model has the largest mean of this"
    )
    stop_at: Fraction = Field(
        default=0.0, description="cleared rate that ends the training; 0: never"
    )
    patience: Annotated[Integer, Field(ge=0)] = Field(
        default=0, description="measurements without a new best that end the training; 0: never"
    )


@dataclass(frozen=True, config=_CHECKED)
class Evaluation:
    """How a policy is measured: all policies play the same levels with the same seeds."""

    suites: tuple[SuiteName, ...] = Field(
        default=("games",),
        description="games: whole ones as in the training; the others play levels until they are "
        "cleared: training: those of the training; test: generated from the test seeds; named: "
        "the named levels",
    )
    episodes: Count = Field(default=100, description="whole games, one per seed")
    level_episodes: Count = Field(default=10, description="episodes of each level, one per seed")
    planner_episodes: Count = Field(
        default=2, description="most of these that the planner plays, which is slow"
    )
    generated: Count = Field(default=20, description="generated levels in a suite")
    seed: Seed = Field(default=1_000_000, description="spread over the episodes")
    deterministic: Switch = Field(
        default=True, description="whether a policy takes the likeliest action or draws one"
    )
    baselines: tuple[BaselineName, ...] = Field(
        default=BASELINES, description="who else is measured; the planner plays no whole games"
    )
    film_seconds: Positive = Field(default=20.0, description="length of the film, in game time")


@dataclass(frozen=True, config=_CHECKED)
class Experiment:
    """One training run: everything that decides its outcome, and where it goes.

    Pydantic's ValidationError, a ValueError, says what is wrong with an experiment made in Python.
    """

    name: str = Field(default="experiment", description="begins the name of the run's folder")
    seed: Seed = Field(default=0, description="of weights, actions and worlds")
    output: str = Field(default="runs", description="the folder that gets the run's folder")
    env_id: str = Field(
        default="Arkanoid-v0",
        description='a registered id of this game; "module:id" imports the module',
    )
    env: dict[str, Any] = Field(
        default_factory=dict, description="a keyword argument of the environment"
    )
    training: Training = field(default_factory=Training)
    ppo: Ppo = field(default_factory=Ppo)
    network: Network = field(default_factory=Network)
    imitation: Imitation = field(default_factory=Imitation)
    curriculum: Curriculum = field(default_factory=Curriculum)
    validation: Validation = field(default_factory=Validation)
    evaluation: Evaluation = field(default_factory=Evaluation)

    @cached_property
    def config(self) -> Config:
        """The environment's configuration, from what ``env_id`` stands for and ``[env]``.

        It says nothing about level files, which the environment reads when it is made.
        """
        try:
            return resolve_config(self.env_id, self.env)
        except (gym.error.Error, ImportError) as error:
            raise SettingsError(f"'env_id' = {self.env_id!r}: {error}") from None
        except (TypeError, ValueError) as error:
            if not self.env:
                raise SettingsError(f"'env_id' = {self.env_id!r}: {error}") from None
            raise SettingsError(f"{self.env_id} refuses the [env] table: {error}") from None

    @cached_property
    def game(self) -> Config:
        """The configuration for measuring and showing: whole games, whatever ends an episode."""
        return replace(self.config, episodic_life=False)

    @property
    def inputs(self) -> str:
        """What an agent sees, in words: the observation, and what is said about landings."""
        inputs = self.config.observation
        if self.config.landing:
            inputs += ", with the landings of the balls among walls, bricks and the boss"
        if self.network.features == "landing":
            inputs += ", with the landings of the balls among the walls alone"
        return inputs

    def __post_init__(self) -> None:
        forbidden = not set(self.name).isdisjoint('/\\:*?"<>|')
        if not self.name or forbidden or not self.name.isprintable():
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
        self._check_sampling()

    def _check_features(self) -> None:
        """Refuse observations that no network here takes, and features that do not suit one."""
        if "device" in self.env:
            raise SettingsError("'env.device': 'training.device' says where games are played")
        observation = self.config.observation
        if observation == "dict" or self.config.channels == "last":
            raise SettingsError(
                "'env.observation' = 'dict' and 'env.channels' = 'last' are for other trainers: "
                "the networks here take one array, with the channels first"
            )
        suited = {
            "landing": ("vector",),
            "lattice": ("vector",),
            "planes": ("grid", "rgb"),
            "nature": ("rgb",),
        }
        wanted = suited.get(self.network.features)
        if wanted is not None and observation not in wanted:
            raise SettingsError(
                f"'network.features' = {self.network.features!r} is for 'env.observation' = "
                f"{' or '.join(map(repr, wanted))}, not {observation!r}; 'auto' takes what suits"
            )
        if self.network.features in ("auto", "lattice", "planes") and not self.network.channels:
            raise SettingsError("'network.channels' must name at least one convolution's channels")

    def _check_sampling(self) -> None:
        """Refuse a replay of levels that cannot be chosen, or that are kept for the test."""
        if self.curriculum.sampling == "uniform":
            return
        # Imported on demand, because it brings kernels.
        from ...envs.levels.plan import TEST_SEEDS, seed_range

        try:
            seeds = seed_range(self.config.levels)
        except ValueError as error:
            raise SettingsError(f"'env.levels': {error}") from None
        if seeds is None:
            return
        if seeds.start < TEST_SEEDS.stop and seeds.stop > TEST_SEEDS.start:
            raise SettingsError(
                f"'env.levels' = {self.config.levels!r} has test seeds, from {TEST_SEEDS.start:,} "
                f"on: a curriculum chooses among training levels only"
            )
        if self.curriculum.rounds:
            raise SettingsError(
                "'curriculum.sampling' chooses seeds where 'env.levels' are generated: leave out "
                "'curriculum.rounds'"
            )


def load_experiment(config: str, overrides: Sequence[tuple[str, str]] = ()) -> Experiment:
    """Return the experiment of a TOML file or of a packaged config's name.

    ``overrides`` are pairs of a dotted key and the text of its value, as in
    ``[("ppo.learning_rate", "1e-3")]``. Raises `SettingsError` if the file is missing or is not
    TOML, or if a setting is unknown or wrong.
    """
    source, table = read_toml(config)
    return read_settings(Experiment, table, source, overrides)
