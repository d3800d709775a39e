"""PPO agents that learn to beat the game: training, measuring and showing them.

`adapter.GymnasiumVecEnv`, which lets stable-baselines3 train on a Gymnasium vector environment, is
for everybody. The rest serves the command `arkanoid` (`cli`); its rooms import one way: `commands`
from `show`, `learn`, `measure` and `experiment`, each from those after it.
"""
