"""The subcommands of `arkanoid`, a module each."""
