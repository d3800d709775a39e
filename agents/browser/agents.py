"""Agents for the page."""

from typing import NamedTuple

from ...envs.config import Config
from ..experiment.runs import ModelFile
from ..experiment.settings import Experiment
from ..learn.portable import portable_network


class BrowserAgent(NamedTuple):
    """An agent that the page shows.

    Attributes:
        name: shown, and unique on the page.
        config: of the game that it plays.
        network: the file of `portable_network`; None if the page asks its server for it.
    """

    name: str
    config: Config
    network: bytes | None


def browser_agent(model: ModelFile, experiment: Experiment) -> BrowserAgent:
    """Return a saved model for the page.

    Raises `SettingsError` if the file cannot be read, or no browser can play such a network.
    """
    return BrowserAgent(experiment.name, experiment.game, portable_network(model, experiment))
