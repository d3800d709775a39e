"""Settings: what is read, what is refused with which words, and the resolved configuration."""

import tomllib
from collections.abc import Iterator
from dataclasses import FrozenInstanceError, replace
from inspect import signature
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from arkanoid.agents import cli
from arkanoid.agents.experiment.errors import SettingsError
from arkanoid.agents.experiment.packaged import packaged_configs
from arkanoid.agents.experiment.reading import (
    describe_settings,
    read_settings,
    to_toml,
)
from arkanoid.agents.experiment.settings import Experiment, Ppo, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds, native
from arkanoid.agents.measure.suites import make_suites
from arkanoid.envs import ArkanoidVectorEnv
from arkanoid.envs.config import Config
from arkanoid.envs.hints import BATCH_KEYWORDS
from arkanoid.envs.registration import make_vector_env, resolve_config
from helpers.processes import run_program
from hypothesis import given
from hypothesis import strategies as st

FILE = "experiment.toml"


def write(folder: Path, text: str) -> str:
    path = folder / FILE
    path.write_text(text, encoding="utf-8")
    return str(path)


def test_an_empty_file_is_the_default_experiment(tmp_path: Path) -> None:
    assert load_experiment(write(tmp_path, "")) == Experiment()


def test_a_file_sets_what_it_names_and_nothing_else(tmp_path: Path) -> None:
    path = write(tmp_path, "seed = 7\n[env]\nlives = 1\n[ppo]\ngamma = 1\n[network]\nhidden = [8]")
    experiment = load_experiment(path)
    default = Experiment()
    assert experiment == replace(
        default,
        seed=7,
        env={"lives": 1},
        ppo=replace(default.ppo, gamma=1.0),
        network=replace(default.network, hidden=(8,)),
    )
    # Where a number is expected, an integer becomes one.
    assert type(experiment.ppo.gamma) is float


def test_settings_cannot_be_changed_in_place() -> None:
    with pytest.raises(FrozenInstanceError):
        Experiment().seed = 1  # type: ignore[misc]


def test_overrides_win_over_the_file(tmp_path: Path) -> None:
    path = write(tmp_path, 'seed = 7\n[env]\nlives = 1\nactions = "discrete3"')
    experiment = load_experiment(
        path,
        [
            ("seed", "8"),
            ("name", "2024"),
            ("ppo.learning_rate", "1e-3"),
            ("network.hidden", "[16, 16]"),
            ("network.activation", "relu"),
            ("evaluation.deterministic", "false"),
            ("env.lives", "2"),
            ("env.reward", "score"),
            ("env.levels", '["ripple", "comb"]'),
        ],
    )
    assert experiment.seed == 8
    assert experiment.name == "2024"
    assert experiment.ppo.learning_rate == 1e-3
    assert experiment.network.hidden == (16, 16)
    assert experiment.network.activation == "relu"
    assert experiment.evaluation.deterministic is False
    assert experiment.env == {
        "lives": 2,
        "actions": "discrete3",
        "reward": "score",
        "levels": ["ripple", "comb"],
    }


def test_a_config_may_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "marked.toml"
    path.write_text("seed = 7", encoding="utf-8-sig")
    assert load_experiment(str(path)).seed == 7


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[ppo]\nlearning_rat = 1.0", ["'ppo.learning_rat'", "'ppo.learning_rate'", "a number"]),
        ("learning_rate = 1.0", ["unknown key 'learning_rate'", "'ppo.learning_rate'"]),
        ("[poo]\ngamma = 1.0", ["unknown key 'poo'"]),
        ("[training]\nworld = 3", ["'training.world'", "'training.worlds'", "an integer"]),
        ("sede = 3", ["'sede'", "'seed'", "an integer"]),
        ("zzzzqq = 3", ["'zzzzqq'", "known are name,", "ppo.learning_rate"]),
        ('[ppo]\nn_steps = "many"', ["'ppo.n_steps'", "an integer, at least 1", "'many'"]),
        ("[ppo]\nn_steps = 1.5", ["'ppo.n_steps'", "an integer", "1.5"]),
        ("[ppo]\nn_steps = true", ["'ppo.n_steps'", "an integer", "True"]),
        ("[ppo]\nn_steps = 0", ["'ppo.n_steps'", "at least 1", "0"]),
        ("[ppo]\nlearning_rate = 0", ["'ppo.learning_rate'", "a number, above 0"]),
        ("[ppo]\nlearning_rate = nan", ["'ppo.learning_rate'", "a number", "nan"]),
        ("[ppo]\nlearning_rate = true", ["'ppo.learning_rate'", "a number", "True"]),
        ("[ppo]\nvf_coef = inf", ["'ppo.vf_coef'", "a number", "inf"]),
        ("[ppo]\ngamma = 1.5", ["'ppo.gamma'", "at least 0 and at most 1", "1.5"]),
        ("name = 3", ["'name'", "a text", "3"]),
        ('name = "a/b"', ["'name'", "'a/b'"]),
        ('output = ""', ["'output'"]),
        ("[evaluation]\ndeterministic = 1", ["'evaluation.deterministic'", "true or false"]),
        ("[network]\nhidden = 64", ["'network.hidden'", "a list of integers"]),
        ("[network]\nhidden = [64, 0]", ["'network.hidden'", "each at least 1", "[64, 0]"]),
        ('[network]\nactivation = "rellu"', ["'network.activation'", "'relu'", "'rellu'"]),
        ("ppo = 3", ["'ppo'", "a table"]),
        ("env = 3", ["'env'", "a table"]),
        ("[ppo]\nbatch_size = 1000", ["'ppo.batch_size' (1000)", "8192"]),
        ("seed = ", ["not a TOML file"]),
        ("[curriculum]\nstages = [0.5, 0.5]", ["'curriculum.stages' must rise"]),
        ("[curriculum]\nstages = [2.0]", ["'curriculum.stages'", "each above 0 and at most 1"]),
        ("[curriculum]\nstages = [0.5]", ["'curriculum.difficulty' or 'curriculum.rounds'"]),
        (
            "[curriculum]\nstages = [0.5]\nrounds = [1]",
            ["'curriculum.rounds'", "2 stages", "not 1"],
        ),
        ("[curriculum]\ndifficulty = 0.5", ["'curriculum.difficulty'", "a list of numbers"]),
        ("[validation]\nlevels = [3]", ["'validation.levels'", "a list of texts", "[3]"]),
        ('[validation]\nbest = "hits"', ["'validation.best'", "'cleared'", "'hits'"]),
        ("[validation]\nstop_at = 1.5", ["'validation.stop_at'", "at most 1"]),
        ('[evaluation]\nsuites = ["all"]', ["'evaluation.suites'", "'named'", "['all']"]),
        ('[network]\nfeatures = "planes"', ["'network.features'", "'grid'", "'vector'"]),
        ('env = {observation = "grid"}\nnetwork = {features = "landing"}', ["'grid'", "'vector'"]),
        ('env = {observation = "rgb"}\nnetwork = {features = "lattice"}', ["'rgb'", "'vector'"]),
        ("[network]\nchannels = []", ["'network.channels'", "at least one"]),
        ('env = {observation = "dict"}', ["'env.observation' = 'dict'", "other trainers"]),
        ('env = {observation = "rgb", channels = "last"}', ["'env.channels'", "channels first"]),
        ("[env]\nlivs = 3", ["Arkanoid-v0 refuses the [env] table", "'livs'", "'lives'"]),
        ("[env]\nlives = 0", ["Arkanoid-v0 refuses the [env] table", "lives", "got 0"]),
        ('env_id = "Arkanod-v0"', ["'env_id'", "'Arkanod-v0'"]),
        ('env_id = "no_such_module:X-v0"', ["'env_id'", "no_such_module"]),
        ('env_id = "CartPole-v1"', ["CartPole-v1", "not an ArkanoidVectorEnv"]),
    ],
)
def test_a_wrong_setting_is_named_with_its_file_and_what_is_right(
    tmp_path: Path, text: str, words: list[str]
) -> None:
    path = write(tmp_path, text)
    with pytest.raises(SettingsError) as caught:
        load_experiment(path)
    message = str(caught.value)
    assert message.startswith(path)
    assert "\n" not in message
    for word in words:
        assert word in message


@pytest.mark.parametrize(
    ("key", "text", "words"),
    [
        ("ppo.learning_rat", "1", ["'ppo.learning_rat'", "'ppo.learning_rate'"]),
        ("worlds", "1", ["'worlds'", "'training.worlds'"]),
        ("ppo", "1", ["unknown key 'ppo'; known are ppo.learning_rate,"]),
        ("seed.x", "1", ["unknown key 'seed.x'"]),
        ("ppo.n_steps", "many", ["'ppo.n_steps'", "an integer, at least 1", "'many'"]),
        ("ppo.n_steps", "1\nseed = 2", ["'ppo.n_steps'", "an integer"]),
        ("ppo.batch_size", "1000", ["'ppo.batch_size' (1000)"]),
        ("env.lives", "none", ["lives must be an integer", "'none'"]),
        # The nearest key, however far, was 'env_id'.
        ("colour", "red", ["unknown key 'colour'; known are name,"]),
    ],
)
def test_a_wrong_override_is_blamed_on_the_command_line(
    tmp_path: Path, key: str, text: str, words: list[str]
) -> None:
    with pytest.raises(SettingsError) as caught:
        load_experiment(write(tmp_path, ""), [(key, text)])
    for word in ["command line", *words]:
        assert word in str(caught.value)


@pytest.mark.parametrize("text", ["1e6", "1000000", "1_000_000", "1E+6", "1000000.0"])
def test_a_million_is_an_integer_however_it_is_written(tmp_path: Path, text: str) -> None:
    """``1e6`` was refused: TOML takes it for a floating-point number."""
    path = write(tmp_path, f"[training]\ntimesteps = {text}\n[network]\nhidden = [64.0]")
    for experiment in (
        load_experiment(path),
        load_experiment("quick", [("training.timesteps", text)]),
    ):
        assert experiment.training.timesteps == 1_000_000
        assert type(experiment.training.timesteps) is int
    assert load_experiment(path).network.hidden == (64,)


def test_a_missing_file_lists_the_packaged_configs() -> None:
    with pytest.raises(SettingsError) as caught:
        load_experiment("no_such.toml")
    assert "no_such.toml" in str(caught.value)
    assert packaged_configs()
    for name in packaged_configs():
        assert name in str(caught.value)


def test_a_file_that_is_not_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / FILE).write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SettingsError, match="not a TOML file"):
        load_experiment(str(tmp_path / FILE))


@pytest.mark.parametrize("name", packaged_configs())
def test_every_packaged_config_is_valid(name: str) -> None:
    assert load_experiment(name).name == name


def test_a_setting_made_in_python_is_checked_too() -> None:
    with pytest.raises(ValueError, match=r"gamma\n.*less than or equal to 1"):
        Ppo(gamma=2.0)
    with pytest.raises(ValueError, match=r"'ppo\.batch_size'"):
        replace(Experiment(), ppo=Ppo(batch_size=1000))


def test_every_setting_says_what_it_means() -> None:
    settings = describe_settings(Experiment)
    assert all(setting.meaning and setting.expected for setting in settings.values())
    assert settings["ppo.gamma"].default == Ppo().gamma


numbers = st.floats(1e-12, 1, allow_subnormal=False)
counts = st.integers(1, 16_384)
# TOML has no surrogates.
texts = st.text(st.characters(exclude_categories=["Cs"]), min_size=1)


@given(
    seed=st.integers(0, 2**32 - 1),
    output=texts,
    levels=st.lists(texts, min_size=1, max_size=3),
    sticky=st.floats(0, 1),
    gamma=numbers,
    hidden=st.lists(counts, max_size=3),
)
def test_written_settings_are_read_back_equal(
    seed: int, output: str, levels: list[str], sticky: float, gamma: float, hidden: list[int]
) -> None:
    default = Experiment()
    experiment = replace(
        default,
        seed=seed,
        output=output,
        env={"levels": levels, "sticky_action": sticky, "enemies": False},
        ppo=replace(default.ppo, gamma=gamma),
        network=replace(default.network, hidden=tuple(hidden)),
    )
    assert read_settings(Experiment, tomllib.loads(to_toml(experiment)), "here") == experiment


MY_GAME = "MyLite-v0"
MY_DEFAULTS = {"enemies": False, "capsules": False, "frame_skip": 2}


class MyVectorEnv(ArkanoidVectorEnv):
    """A user's own class."""


@pytest.fixture(params=["arkanoid.envs.vector_env:ArkanoidVectorEnv", MyVectorEnv])
def my_game(request: pytest.FixtureRequest) -> Iterator[str]:
    """An id of a user's own, with defaults that are not ours."""
    gym.register(
        MY_GAME,
        entry_point="arkanoid.envs.arkanoid_env:ArkanoidEnv",
        vector_entry_point=request.param,
        kwargs=MY_DEFAULTS,
    )
    yield MY_GAME
    del gym.registry[MY_GAME]


def test_an_experiment_knows_the_defaults_of_a_users_own_id(my_game: str) -> None:
    """Agents had their own copies of the environment's defaults.

    The suite ``named`` then asked for the boss in a game without enemies, and evaluating ended in
    a traceback.
    """
    suites = ("evaluation.suites", '["named"]')
    experiment = load_experiment("quick", [("env_id", my_game), ("env.lives", "5"), suites])
    assert experiment.config == Config(
        enemies=False, capsules=False, frame_skip=4, lives=5, life_penalty=1.0, landing=True
    )
    names = [start.name for start in make_suites(experiment)["named"].starts]
    assert len(names) == 12
    assert "warden" not in names
    worlds = make_worlds(experiment, 1)
    assert native(worlds).config == experiment.config
    for name in names:
        worlds.reset(options={"level": name})


def test_without_a_native_vector_environment_there_is_no_training() -> None:
    gym.register("Single-v0", entry_point="arkanoid.envs.arkanoid_env:ArkanoidEnv")
    try:
        with pytest.raises(SettingsError, match="vector_entry_point of Single-v0"):
            load_experiment("quick", [("env_id", "Single-v0")])
    finally:
        del gym.registry["Single-v0"]


@pytest.mark.parametrize("env_id", ["Arkanoid-v0", "ArkanoidLite-v0", "arkanoid:ArkanoidLite-v0"])
def test_a_resolved_configuration_is_that_of_the_environment(env_id: str) -> None:
    keywords: dict[str, Any] = {"lives": 2, "threads": 1, "levels": "seeds:3-5"}
    worlds = gym.make_vec(env_id, 1, "vector_entry_point", **keywords)
    assert resolve_config(env_id, keywords) == worlds.unwrapped.config  # type: ignore[attr-defined]


def test_keywords_of_the_batch_are_no_part_of_a_configuration() -> None:
    """`BATCH_KEYWORDS` is a list by hand, because the constructor's module is slow to import."""
    own = set(signature(ArkanoidVectorEnv).parameters) | set(signature(make_vector_env).parameters)
    assert own - {"num_envs", "keywords"} == set(BATCH_KEYWORDS)


def test_settings_are_checked_without_torch_and_kernels(tmp_path: Path) -> None:
    path = write(tmp_path, "[env]\nlivs = 1")
    done = run_program(
        "import sys; from arkanoid.agents.cli import main\n"
        f"assert main(['train', {path!r}]) == 2\n"
        "assert not {'torch', 'stable_baselines3', 'numba'} & set(sys.modules)"
    )
    assert "'lives'" in done.stderr


def test_playing_by_hand_needs_no_package_for_training() -> None:
    """Neither does the help that lists all commands, nor that of the game's own commands."""
    run_program(
        "import sys; sys.modules['pydantic'] = sys.modules['tomli_w'] = None\n"
        "from arkanoid.agents.cli import main\n"
        "assert main(['levels', 'ripple']) == 0\n"
        "for words in (['--help'], ['play', '--help'], ['replay', '--help'], ['levels', '-h']):\n"
        "    try: main(words)\n"
        "    except SystemExit as stop: assert stop.code == 0\n"
    )


def test_every_command_explains_itself(capsys: pytest.CaptureFixture[str]) -> None:
    for name, summary in cli.COMMANDS.items():
        with pytest.raises(SystemExit) as stop:
            cli.main([name, "--help"])
        assert stop.value.code == 0
        assert summary in capsys.readouterr().out


def test_agents_are_measured_in_whole_games(tmp_path: Path) -> None:
    """An episode that ends with a life is for training: a game's score is that of all its lives."""
    experiment = load_experiment(write(tmp_path, "[env]\nepisodic_life = true\nlives = 2"))
    assert experiment.config.episodic_life
    assert experiment.game == replace(experiment.config, episodic_life=False)


def test_a_quoted_dotted_key_is_explained(tmp_path: Path) -> None:
    """It said that 'training.worlds' was unknown, and that 'training.worlds' was meant."""
    path = tmp_path / "quoted.toml"
    path.write_text('"training.worlds" = 3\n')
    with pytest.raises(SettingsError, match="in quotation marks is one word"):
        load_experiment(str(path))


def test_an_experiment_made_in_python_is_written_as_toml(tmp_path: Path) -> None:
    """A range of seeds, a legal value of `levels`, ended in a TypeError."""
    env = {"levels": range(3, 9), "difficulty": None, "lives": np.int64(2)}
    path = tmp_path / "made.toml"
    path.write_text(to_toml(Experiment(env=env)), encoding="utf-8")
    assert load_experiment(str(path)).env == {"levels": "seeds:3-8", "lives": 2}
