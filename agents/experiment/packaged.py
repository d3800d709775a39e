"""The configs and the trained agents that come with the package; importing this costs nothing."""

from importlib import resources
from pathlib import Path

from ... import configs
from .. import pretrained

# How the names of packaged experiments end.
CONFIG = ".toml"
# The agent that plays where none is named.
DEFAULT_AGENT = "lite"


def packaged_configs(suffix: str = CONFIG) -> list[str]:
    """Return the names of the configs, or of other TOML files, that come with the package."""
    files = (file.name for file in resources.files(configs).iterdir())
    names = (name.removesuffix(suffix) for name in files if name.endswith(suffix))
    # A further dot in the name marks another kind of file.
    return sorted(name for name in names if "." not in name)


def read_packaged(name: str, suffix: str = CONFIG) -> str:
    """Return the text of one of `packaged_configs`."""
    return (resources.files(configs) / f"{name}{suffix}").read_text(encoding="utf-8")


def packaged_agents() -> list[str]:
    """Return the names of the trained agents that come with the package."""
    folders = (folder for folder in _agents().iterdir() if (folder / "config.toml").is_file())
    return sorted(folder.name for folder in folders)


def find_agent(name: str | None) -> Path:
    """Return the path that a name stands for.

    A name of `packaged_agents` stands for the folder of this agent's run, unless there is such a
    path; None for that of `DEFAULT_AGENT`. Any other name is a path.
    """
    if name is None:
        return _agents() / DEFAULT_AGENT
    path = Path(name)
    return _agents() / name if name in packaged_agents() and not path.exists() else path


def _agents() -> Path:
    return Path(str(resources.files(pretrained)))
