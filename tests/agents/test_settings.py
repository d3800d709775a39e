import subprocess
import sys
import tomllib
from dataclasses import FrozenInstanceError, replace
from pathlib import Path

import pytest
from arkanoid.agents.experiment.schema import SettingsError, leaves, read_settings, to_toml
from arkanoid.agents.experiment.settings import Experiment, Ppo, load_experiment, packaged_configs
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
    # An integer is a number where one is asked for, and becomes one.
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
    assert experiment.evaluation.deterministic is False
    assert experiment.env == {
        "lives": 2,
        "actions": "discrete3",
        "reward": "score",
        "levels": ["ripple", "comb"],
    }


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[ppo]\nlearning_rat = 1.0", ["'ppo.learning_rat'", "'ppo.learning_rate'", "a number"]),
        ("learning_rate = 1.0", ["unknown key 'learning_rate'", "'ppo.learning_rate'"]),
        ("[poo]\ngamma = 1.0", ["unknown key 'poo'"]),
        ("[training]\nworld = 3", ["'training.world'", "'training.worlds'", "an integer"]),
        ("sede = 3", ["'sede'", "'seed'", "an integer"]),
        ("zzzzqq = 3", ["'zzzzqq'", "nearest known key"]),
        ('[ppo]\nn_steps = "many"', ["'ppo.n_steps'", "an integer, at least 1", "'many'"]),
        ("[ppo]\nn_steps = 1.5", ["'ppo.n_steps'", "an integer", "1.5"]),
        ("[ppo]\nn_steps = true", ["'ppo.n_steps'", "an integer", "True"]),
        ("[ppo]\nn_steps = 0", ["'ppo.n_steps'", "at least 1", "0"]),
        ("[ppo]\nlearning_rate = 0", ["'ppo.learning_rate'", "a number, above 0"]),
        ("[ppo]\nlearning_rate = nan", ["'ppo.learning_rate'", "a number", "nan"]),
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
        ('env = {observation = "rgb"}\nnetwork = {features = "lattice"}', ["'rgb'", "'vector'"]),
        ("[network]\nchannels = []", ["'network.channels'", "at least one"]),
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
    for word in words:
        assert word in message


@pytest.mark.parametrize(
    ("key", "text", "words"),
    [
        ("ppo.learning_rat", "1", ["'ppo.learning_rat'", "'ppo.learning_rate'"]),
        ("worlds", "1", ["'worlds'", "'training.worlds'"]),
        ("ppo", "1", ["unknown key 'ppo'"]),
        ("ppo.n_steps", "many", ["'ppo.n_steps'", "an integer, at least 1", "'many'"]),
        ("ppo.n_steps", "1\nseed = 2", ["'ppo.n_steps'", "an integer"]),
        ("ppo.batch_size", "1000", ["'ppo.batch_size' (1000)"]),
    ],
)
def test_a_wrong_override_is_blamed_on_the_command_line(
    tmp_path: Path, key: str, text: str, words: list[str]
) -> None:
    with pytest.raises(SettingsError) as caught:
        load_experiment(write(tmp_path, ""), [(key, text)])
    for word in ["command line", *words]:
        assert word in str(caught.value)


def test_a_missing_file_lists_the_packaged_configs() -> None:
    with pytest.raises(SettingsError) as caught:
        load_experiment("no_such.toml")
    assert "no_such.toml" in str(caught.value)
    assert packaged_configs()
    for name in packaged_configs():
        assert name in str(caught.value)


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / FILE).write_bytes(b"\xff\xfe\x00")
    with pytest.raises(SettingsError, match="not a TOML file"):
        load_experiment(str(tmp_path / FILE))


@pytest.mark.parametrize("name", packaged_configs())
def test_every_packaged_config_is_valid(name: str) -> None:
    assert load_experiment(name).name == name


def test_a_setting_made_in_python_is_checked_too() -> None:
    with pytest.raises(SettingsError, match="'gamma' must be a number, at least 0 and at most 1"):
        Ppo(gamma=2.0)


def test_every_setting_says_what_it_means() -> None:
    assert all(leaf.meaning for leaf in leaves(Experiment) if not leaf.is_table)


numbers = st.floats(1e-12, 1, allow_subnormal=False)
counts = st.integers(1, 10**9)
# TOML has no surrogates.
texts = st.text(st.characters(exclude_categories=["Cs"]))
toml_values = st.recursive(
    st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False) | texts,
    lambda values: st.lists(values, max_size=3) | st.dictionaries(texts, values, max_size=3),
    max_leaves=5,
)


@given(
    seed=st.integers(0, 2**32 - 1),
    output=texts.filter(bool),
    env=st.dictionaries(texts, toml_values, max_size=4),
    gamma=numbers,
    hidden=st.lists(counts, max_size=3),
)
def test_written_settings_are_read_back_equal(
    seed: int, output: str, env: dict[str, object], gamma: float, hidden: list[int]
) -> None:
    default = Experiment()
    experiment = replace(
        default,
        seed=seed,
        output=output,
        env=env,
        ppo=replace(default.ppo, gamma=gamma),
        network=replace(default.network, hidden=tuple(hidden)),
    )
    assert read_settings(Experiment, tomllib.loads(to_toml(experiment)), "here") == experiment


def test_settings_are_read_without_torch(tmp_path: Path) -> None:
    path = write(tmp_path, "[ppo]\ngama = 1")
    program = (
        "import sys; from arkanoid.agents.cli import main; "
        f"status = main(['train', {path!r}]); "
        "assert status == 2; assert not {'torch', 'stable_baselines3'} & set(sys.modules)"
    )
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert "'ppo.gamma'" in result.stderr
