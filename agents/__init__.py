"""PPO agents that learn to beat the game."""
