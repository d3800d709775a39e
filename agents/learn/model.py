"""PPO: making a model, saving and loading it, and using it as a policy."""

import io
import itertools
import math
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import torch
from stable_baselines3 import PPO
from stable_baselines3.common.policies import ActorCriticPolicy, BasePolicy
from stable_baselines3.common.utils import LinearSchedule
from stable_baselines3.common.vec_env import VecEnv

from ...envs.atomic import write_atomically
from ..experiment.errors import SettingsError
from ..experiment.packed import SETTINGS, WEIGHTS
from ..experiment.provenance import memory_gib
from ..experiment.reading import to_toml
from ..experiment.runs import ModelFile
from ..experiment.seeds import Purpose, spread_seed
from ..experiment.settings import Experiment, Ppo
from ..experiment.worlds import make_worlds, native
from ..measure.policy import Policy
from .checkpoints import read_checkpoint
from .networks import ACTIVATIONS, extractor_arguments
from .playing import ModelPolicy, device_beside, find_device
from .ppo import FastPPO
from .tensors import is_like, read_entry, read_tensors

# What stable-baselines3 would save, and only a training needs.
_OF_THE_TRAINING = ("_last_obs", "_last_episode_starts", "ep_info_buffer", "ep_success_buffer")


def make_model(experiment: Experiment, venv: VecEnv) -> PPO:
    """Return an untrained PPO; all random numbers come from the experiment's seed.

    Raises `SettingsError` if what it collects between two updates does not fit into memory, or the
    device is not there.
    """
    torch.set_num_threads(experiment.training.torch_threads)
    ppo = experiment.ppo
    _check_memory(experiment, venv)
    trainer = FastPPO if experiment.training.trainer == "fast" else PPO
    return trainer(
        "CnnPolicy" if experiment.config.observation == "rgb" else "MlpPolicy",
        venv,
        learning_rate=_scheduled(ppo, ppo.learning_rate),
        n_steps=ppo.n_steps,
        batch_size=ppo.batch_size,
        n_epochs=ppo.n_epochs,
        gamma=ppo.gamma,
        gae_lambda=ppo.gae_lambda,
        clip_range=_scheduled(ppo, ppo.clip_range),
        ent_coef=ppo.ent_coef,
        vf_coef=ppo.vf_coef,
        max_grad_norm=ppo.max_grad_norm,
        policy_kwargs=_policy_arguments(experiment, venv.get_attr("layout", 0)[0]),
        seed=experiment.seed,
        device=find_device(experiment.training.device),
    )


def save_model(model: PPO, path: Path, experiment: Experiment) -> None:
    """Write the model and its settings to ``path``, atomically; `PPO.load` reads it.

    With the settings in it, the file is enough to play. The optimiser's state, twice as large as
    the weights, is left out: playing does not need it.
    """
    policy: Any = model.policy
    used = policy.optimizer
    policy.optimizer = policy.optimizer_class(
        policy.parameters(), lr=model.lr_schedule(1.0), **policy.optimizer_kwargs
    )
    buffer = io.BytesIO()
    try:
        model.save(buffer, exclude=_OF_THE_TRAINING)
    finally:
        policy.optimizer = used
    with zipfile.ZipFile(buffer, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(SETTINGS, to_toml(experiment))
    write_atomically(path, buffer.getbuffer())


def load_policy(model: ModelFile, experiment: Experiment) -> Policy:
    """Return the saved model as a policy that plays as the experiment's evaluation says.

    The network is built from the run's settings, and only its weights are read from the file. If
    the run is trusted, stable-baselines3 unpickles the file instead, which can hold any network.
    Raises `SettingsError` if the file cannot be read or holds another network.
    """
    torch.set_num_threads(experiment.training.torch_threads)
    device = _playing_device(model, experiment)
    network = _unpickled(model.path) if model.run.trusted else rebuild_network(model, experiment)
    settings = experiment.evaluation
    seed = spread_seed(settings.seed, Purpose.EVALUATION_POLICY)
    worlds = device_beside(device)
    return ModelPolicy(network.to(device), settings.deterministic, seed, worlds)


def read_weights(path: Path, experiment: Experiment) -> dict[str, torch.Tensor]:
    """Return a saved model's weights, which fit the experiment's network; no code is run.

    `policy.load_state_dict` puts them into any model of the experiment. Raises `SettingsError` if
    the file cannot be read or holds another network.
    """
    try:
        return _read_weights(path, _unfilled(experiment).state_dict())
    except Exception as error:  # a damaged file can raise anything
        raise SettingsError(
            f"{path}: not a model of the experiment's network ({error}): a training can only begin "
            f"with the weights of a model that has the same network, observation and actions"
        ) from None


def _playing_device(model: ModelFile, experiment: Experiment) -> torch.device:
    """Return where a model plays: also without the graphics card that trained it."""
    wanted = experiment.training.device
    as_trained = wanted == "cuda" and model.run.experiment().training.device == "cuda"
    return find_device("auto" if as_trained else wanted)


class _UnfilledPolicy(ActorCriticPolicy):
    """A network without weights, into which the weights of a file are put.

    Built under ``torch.device("meta")``, it takes no memory, however large it is.
    """

    @property
    def device(self) -> torch.device:
        """Where the weights are; before there are any, where they will be."""
        first = next(self.parameters(), None)
        return torch.device("meta") if first is None else first.device


def rebuild_network(model: ModelFile, experiment: Experiment) -> BasePolicy:
    """Return the run's network with the weights of the file; no code is run.

    The file may be the run's checkpoint, too: a training that goes on has no other.

    Raises `SettingsError` if the file cannot be read or holds another network.
    """
    # An evaluation can change the game, but not the network.
    policy = _unfilled(replace(experiment, network=model.run.experiment().network))
    try:
        if model.path == model.run.checkpoint:
            weights = _fitting(read_checkpoint(model.path)["policy"], policy.state_dict())
        else:
            weights = _read_weights(model.path, policy.state_dict())
    except Exception as error:  # a damaged file can raise anything
        raise SettingsError(
            f"{model.path}: the weights cannot be read ({error}); the file must hold the network "
            f"of the run in its folder. With --trust, stable-baselines3 reads any model, which can "
            f"run code that its author put into it"
        ) from None
    policy.load_state_dict(weights, assign=True)
    policy.set_training_mode(False)
    return policy


def _unfilled(experiment: Experiment) -> _UnfilledPolicy:
    """Return the experiment's network without weights."""
    worlds = make_worlds(experiment, 1)
    try:
        observations, actions = worlds.single_observation_space, worlds.single_action_space
        layout = native(worlds).layout
    finally:
        worlds.close()
    with torch.device("meta"):
        return _UnfilledPolicy(
            observations,
            actions,
            lambda _: 1.0,
            ortho_init=False,
            **_policy_arguments(experiment, layout),
        )


def _read_weights(path: Path, expected: dict[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """Return the weights in a model's file; raise ValueError if they do not fit ``expected``."""
    size = sum(tensor.numel() * tensor.element_size() for tensor in expected.values())
    # Each tensor also has a name, a header and padding.
    limit = size + 4096 * (len(expected) + 1)
    with zipfile.ZipFile(path) as archive:
        if WEIGHTS not in archive.namelist():
            raise ValueError(f"there is no {WEIGHTS} in it")
        weights = read_tensors(read_entry(archive, WEIGHTS, limit))
    return _fitting(weights, expected)


def _fitting(weights: Any, expected: dict[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """Return copies of weights; raise ValueError if they do not fit ``expected``."""
    if not isinstance(weights, dict) or weights.keys() != expected.keys():
        raise ValueError("they belong to another network")
    for name, tensor in weights.items():
        if not is_like(tensor, expected[name]):
            raise ValueError(f"{name} belongs to another network")
        if not torch.isfinite(tensor).all():
            raise ValueError(f"{name} has values that are not finite")
    # Copies are aligned in memory as in a trained network, so that sums round in the same way.
    return {name: tensor.clone() for name, tensor in weights.items()}


def _unpickled(path: Path) -> BasePolicy:
    """Return the network in a file; reading it can run any code."""
    try:
        return PPO.load(path, device="cpu").policy
    except Exception as error:  # unpickling can raise anything
        raise SettingsError(f"{path}: stable-baselines3 cannot read it: {error}") from None


def _policy_arguments(experiment: Experiment, layout: Mapping[str, slice]) -> dict[str, Any]:
    """Return stable-baselines3's ``policy_kwargs``."""
    network = experiment.network
    return {
        "net_arch": list(network.hidden),
        "activation_fn": ACTIVATIONS[network.activation],
        **extractor_arguments(network, experiment.config, layout),
    }


def _check_memory(experiment: Experiment, venv: VecEnv) -> None:
    """Refuse what does not fit into the machine's memory; Linux would kill the process."""
    space, memory = venv.observation_space, memory_gib()
    if memory is None or space.shape is None or space.dtype is None:
        return
    size = math.prod(space.shape)
    decisions = experiment.ppo.n_steps * experiment.training.worlds
    rollouts = decisions * size * space.dtype.itemsize / 2**30
    if rollouts > memory:
        raise SettingsError(
            f"'ppo.n_steps' times 'training.worlds' are {decisions:,} decisions, whose observations"
            f" take {rollouts:,.0f} GiB, and this machine has {memory:,.0f}"
        )
    # Two networks; each weight also has a gradient and Adam's two moments.
    pairs = itertools.pairwise((size, *experiment.network.hidden))
    layers = 2 * 4 * 4 * sum(one * other for one, other in pairs) / 2**30
    if layers > memory:
        raise SettingsError(
            f"'network.hidden' = {list(experiment.network.hidden)} takes {layers:,.0f} GiB, and "
            f"this machine has {memory:,.0f}"
        )


def _scheduled(ppo: Ppo, start: float) -> float | LinearSchedule:
    """Return a constant, or a schedule that falls to 0 at the end, for stable-baselines3."""
    return start if ppo.schedule == "constant" else LinearSchedule(start, 0.0, 1.0)
