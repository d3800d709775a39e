"""The run of the agent that comes with the package."""
