"""The error that a user's mistake raises; importing it costs nothing."""


class SettingsError(ValueError):
    """A setting, a file or a level that the user names is unknown or wrong."""
