"""TorchRL: one game by its id, and a native batch of many games, sampled by a collector.

TorchRL resets worlds itself, so the batch is made with `autoreset_mode="Disabled"`. "SameStep"
works, too, and adds the numbers of `info` to the data. TorchRL refuses "NextStep".
"""

import gymnasium as gym
import torch
from tensordict.nn import TensorDictModule
from torchrl.collectors import Collector
from torchrl.envs import GymEnv, GymWrapper, check_env_specs
from torchrl.modules import MLP, ProbabilisticActor
from torchrl.modules.distributions import OneHotCategorical

GAME = "arkanoid:ArkanoidLite-v0"
WORLDS = 32


def batch(mode: str) -> GymWrapper:
    """Return a native batch as one TorchRL environment."""
    worlds = gym.make_vec(
        GAME, WORLDS, vectorization_mode="vector_entry_point", autoreset_mode=mode, lives=1
    )
    return GymWrapper(worlds)


def actor(env: GymWrapper) -> ProbabilisticActor:
    """Return an untrained policy."""
    actions = env.action_spec.shape[-1]
    network = MLP(out_features=actions, num_cells=[64, 64])
    return ProbabilisticActor(
        TensorDictModule(network, ["observation"], ["logits"]),
        in_keys=["logits"],
        distribution_class=OneHotCategorical,
        return_log_prob=True,
    )


def main() -> None:
    """Check TorchRL's environments, and collect some steps."""
    torch.manual_seed(0)
    single = GymEnv(GAME)
    check_env_specs(single)
    print("one game:", *single.rollout(20).shape)
    for mode in ("Disabled", "SameStep"):
        env = batch(mode)
        check_env_specs(env)
        env.set_seed(0)
        done = 0
        for data in Collector(env, actor(env), frames_per_batch=6400, total_frames=12_800):
            done += int(data["next", "done"].sum())
            # Within an episode, each observation is the one that the step before led to.
            same = (data["next", "observation"][:, :-1] == data["observation"][:, 1:]).all(-1)
            assert torch.equal(same, ~data["next", "done"][:, :-1, 0])
        print(f"{WORLDS} games, {mode}: {done} episodes in two batches of {data.numel()} steps")


if __name__ == "__main__":
    main()
