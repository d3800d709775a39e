"""The runs of the agents that come with the package, each in a folder of its name."""
