"""Training: PPO, its networks, and what happens between two rollouts."""
