"""How an agent learns: PPO, its networks, and what happens between two rollouts.

Others use `training.train`, `model` (saving and loading), `tuning` and `curves.read_curve`.
"""
