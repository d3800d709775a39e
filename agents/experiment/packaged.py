"""The configs that come with the package; importing this costs nothing."""

from importlib import resources

from ... import configs

# How the names of packaged experiments end.
CONFIG = ".toml"


def packaged_configs(suffix: str = CONFIG) -> list[str]:
    """Return the names of the configs, or of other TOML files, that come with the package."""
    files = (file.name for file in resources.files(configs).iterdir())
    names = (name.removesuffix(suffix) for name in files if name.endswith(suffix))
    # A further dot in the name marks another kind of file.
    return sorted(name for name in names if "." not in name)


def read_packaged(name: str, suffix: str = CONFIG) -> str:
    """Return the text of one of `packaged_configs`."""
    return (resources.files(configs) / f"{name}{suffix}").read_text(encoding="utf-8")
