"""PPO agents that learn to beat the game.

From the outside in: `cli` is the console script; `train` and `evaluate` are its commands;
`settings` says what an experiment is; `adapter` lets stable-baselines3 train on a Gymnasium vector
environment; `learning` is PPO; `episodes`, `baselines` and `report` measure a policy.

Nothing here imports torch or stable-baselines3 before it is needed.
"""
