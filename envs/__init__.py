"""The game and its Gymnasium environments, on nothing but the engine."""
