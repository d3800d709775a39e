"""Decisions a processor-second of trainers: FastPPO, stable-baselines3, sbx, a loop like CleanRL's.

The bound is what the matrix products of dense layers alone would allow, measured in the same run.

Run: python tests/benchmarks/trainers.py [--config quick] [--rollouts 6] [--key value ...]
"""

import argparse
import itertools
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import torch
from arkanoid.agents.cli import split_overrides
from arkanoid.agents.commands.arguments import Parser
from arkanoid.agents.experiment.settings import Experiment, load_experiment
from arkanoid.agents.experiment.worlds import make_worlds
from arkanoid.agents.learn.model import make_model
from arkanoid.agents.learn.networks import ACTIVATIONS
from arkanoid.agents.measure.episodes import adapt
from torch import nn

REPEATS = 3
# Learns from this many decisions before it is measured: then lattices change as in a training.
WARM_UP = 65_536


def of_trainer(experiment: Experiment, trainer: str) -> Callable[[int], object]:
    """Return a function that trains for so many decisions by ``training.trainer``."""
    chosen = replace(experiment, training=replace(experiment.training, trainer=trainer))
    model = make_model(chosen, adapt(make_worlds(chosen, chosen.training.worlds)))
    return model.learn


def of_sbx(experiment: Experiment) -> Callable[[int], object]:
    """Return the same for sbx; raises ImportError without it."""
    import jax
    import sbx

    ppo = experiment.ppo
    arguments: dict[str, Any] = {
        "net_arch": list(experiment.network.hidden),
        "activation_fn": getattr(jax.nn, experiment.network.activation),
    }
    model = sbx.PPO(
        "MlpPolicy",
        adapt(make_worlds(experiment, experiment.training.worlds)),
        n_steps=ppo.n_steps,
        batch_size=ppo.batch_size,
        n_epochs=ppo.n_epochs,
        policy_kwargs=arguments,
    )
    learn: Callable[[int], object] = model.learn
    return learn


def layers(experiment: Experiment, inputs: int, outputs: int) -> nn.Sequential:
    """Return a network of the experiment's widths."""
    widths = (inputs, *experiment.network.hidden)
    parts: list[nn.Module] = []
    for one, other in itertools.pairwise(widths):
        parts += [nn.Linear(one, other), ACTIVATIONS[experiment.network.activation]()]
    return nn.Sequential(*parts, nn.Linear(widths[-1], outputs))


def of_loop(experiment: Experiment) -> Callable[[int], object]:
    """Return the same for PPO in one file, after CleanRL's."""
    ppo, worlds = experiment.ppo, make_worlds(experiment, experiment.training.worlds)
    steps, count = ppo.n_steps, experiment.training.worlds
    (size,) = worlds.single_observation_space.shape  # type: ignore[misc]
    actor = layers(experiment, size, int(worlds.single_action_space.n))  # type: ignore[attr-defined]
    critic = layers(experiment, size, 1)
    weights = [*actor.parameters(), *critic.parameters()]
    adam = torch.optim.Adam(weights, lr=ppo.learning_rate, eps=1e-5)
    seen = torch.zeros(steps, count, size)
    actions, logs, rewards, dones, values = torch.zeros(5, steps, count)
    latest, _ = worlds.reset(seed=0)
    over = torch.zeros(count)

    def rollout() -> tuple[torch.Tensor, torch.Tensor]:
        nonlocal latest, over
        for step in range(steps):
            seen[step], dones[step] = torch.as_tensor(latest), over
            with torch.no_grad():
                drawn = torch.distributions.Categorical(logits=actor(seen[step]))
                action = drawn.sample()
                values[step] = critic(seen[step]).flatten()
            actions[step], logs[step] = action, drawn.log_prob(action)
            latest, reward, terminated, truncated, _ = worlds.step(action.numpy())
            rewards[step] = torch.as_tensor(reward)
            over = torch.as_tensor(terminated | truncated, dtype=torch.float32)
        with torch.no_grad():
            following = critic(torch.as_tensor(latest)).flatten()
        advantages, last, goes_on = torch.zeros(steps, count), torch.zeros(count), 1 - over
        for step in reversed(range(steps)):
            error = rewards[step] + ppo.gamma * following * goes_on - values[step]
            last = error + ppo.gamma * ppo.gae_lambda * goes_on * last
            advantages[step], following, goes_on = last, values[step], 1 - dones[step]
        return advantages, advantages + values

    def update(advantages: torch.Tensor, returns: torch.Tensor) -> None:
        flat = [part.flatten(0, 1) for part in (seen, actions, logs, advantages, returns)]
        for _ in range(ppo.n_epochs):
            for chosen in torch.randperm(steps * count).split(ppo.batch_size):
                observations, action, old, gain, target = (part[chosen] for part in flat)
                drawn = torch.distributions.Categorical(logits=actor(observations))
                ratio = (drawn.log_prob(action) - old).exp()
                gain = (gain - gain.mean()) / (gain.std() + 1e-8)
                clipped = ratio.clamp(1 - ppo.clip_range, 1 + ppo.clip_range)
                loss = torch.max(-gain * ratio, -gain * clipped).mean()
                loss = loss - ppo.ent_coef * drawn.entropy().mean()
                error = critic(observations).flatten() - target
                loss = loss + ppo.vf_coef * error.square().mean()
                adam.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(weights, ppo.max_grad_norm)
                adam.step()

    def learn(decisions: int) -> None:
        for _ in range(max(1, decisions // (steps * count))):
            update(*rollout())

    return learn


def of_products(experiment: Experiment) -> Callable[[int], object]:
    """Return the matrix products of so many decisions, alone: dense, and into the same memory."""
    ppo, worlds = experiment.ppo, make_worlds(experiment, 1)
    (size,) = worlds.single_observation_space.shape  # type: ignore[misc]
    outputs = int(worlds.single_action_space.n)  # type: ignore[attr-defined]
    worlds.close()
    rows = ppo.batch_size
    products = []
    for last in (outputs, 1):
        widths = (size, *experiment.network.hidden, last)
        for index, (one, other) in enumerate(itertools.pairwise(widths)):
            inputs, weight = torch.randn(rows, one), torch.randn(one, other)
            forward, to_inputs = torch.randn(rows, other), torch.empty(rows, one)
            products.append((inputs, weight, forward, torch.empty(one, other), to_inputs, index))

    def multiply(decisions: int) -> None:
        for _ in range(max(1, decisions // rows)):
            # Once while playing; then forwards and backwards in each epoch.
            for epoch in range(ppo.n_epochs + 1):
                for inputs, weight, results, of_weight, to_inputs, index in products:
                    torch.mm(inputs, weight, out=results)
                    if epoch:
                        torch.mm(inputs.t(), results, out=of_weight)
                    if epoch and index:
                        torch.mm(results, weight.t(), out=to_inputs)

    return multiply


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--config", default="quick", help="packaged config or TOML file")
    parser.add_argument("--rollouts", type=int, default=6, help="rollouts per measurement")
    options, words = parser.parse_known_args()
    _, overrides = split_overrides(words, Parser())
    experiment = load_experiment(options.config, [*overrides, ("training.torch_threads", "1")])
    size = experiment.ppo.n_steps * experiment.training.worlds
    torch.set_num_threads(1)
    rows = {
        "stable-baselines3": of_trainer(experiment, "sb3"),
        "FastPPO": of_trainer(experiment, "fast"),
        "a loop like CleanRL's": of_loop(experiment),
        "dense products alone": of_products(experiment),
    }
    try:
        rows["sbx"] = of_sbx(experiment)
    except ImportError:
        print("sbx: not installed (pip install sbx-rl)")
    batch = experiment.ppo.batch_size
    print(f"{options.config}: {size:,} decisions a rollout, minibatches of {batch:,}")
    for train in rows.values():
        train(WARM_UP)
    taken: dict[str, list[float]] = {name: [] for name in rows}
    # In turn, so that all are disturbed alike by what else the machine does.
    for _ in range(REPEATS):
        for name, train in rows.items():
            start = time.process_time()
            train(size * options.rollouts)
            taken[name].append((time.process_time() - start) / (size * options.rollouts))
    slowest = float(np.median(taken["stable-baselines3"]))
    print(f"\n{'':24}{'decisions/s':>14}{'µs each':>10}{'times':>8}")
    for name, seconds in taken.items():
        each = float(np.median(seconds))
        print(f"{name:24}{1 / each:14,.0f}{each * 1e6:10.2f}{slowest / each:8.2f}")


if __name__ == "__main__":
    main()
