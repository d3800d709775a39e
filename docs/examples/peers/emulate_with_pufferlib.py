"""PufferLib's emulation: pictures and numbers as one flat array, and back.

`pufferlib-core` is the part of PufferLib that has wheels; the same code is in PufferLib itself.
"""

import gymnasium as gym
import numpy as np
import pufferlib.emulation
import pufferlib.vector
from pufferlib.pytorch import nativize_dtype, nativize_tensor
from torch import from_numpy

LOOKS = {"observation": "dict", "size": 42, "grey": True, "stack": 2}
WORLDS, STEPS = 4, 200


def game(buf: dict | None = None, seed: int = 0) -> pufferlib.emulation.GymnasiumPufferEnv:
    """Return one emulated game, which writes its observations into a part of the batch's memory."""
    env = gym.make("arkanoid:ArkanoidLite-v0", lives=1, **LOOKS)
    return pufferlib.emulation.GymnasiumPufferEnv(env=env, buf=buf, seed=seed)


def main() -> None:
    """Play several games, and compare what emulation shows of one with the game itself."""
    worlds = pufferlib.vector.make(game, backend=pufferlib.vector.Serial, num_envs=WORLDS)
    worlds.action_space.seed(0)
    worlds.async_reset(seed=0)
    flat = worlds.recv()[0]
    itself = gym.make("arkanoid:ArkanoidLite-v0", lives=1, **LOOKS)
    seen, _ = itself.reset(seed=0)
    shape = nativize_dtype(worlds.emulated)
    over = ends = 0
    for _ in range(STEPS):
        parts = nativize_tensor(from_numpy(flat), shape)
        for name, part in parts.items() if not over else ():
            assert np.array_equal(part[0].numpy(), seen[name])
        actions = worlds.action_space.sample()
        if not over:
            seen, _, over, _, _ = itself.step(int(actions[0]))
        worlds.send(actions)
        flat, _, terminals, *_ = worlds.recv()
        ends += int(terminals.sum())
    print(
        f"emulated: {flat.shape} bytes, {', '.join(parts)}; {ends} games of {WORLDS * STEPS} steps"
    )


if __name__ == "__main__":
    main()
