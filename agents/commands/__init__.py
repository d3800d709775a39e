"""The subcommands of `arkanoid`, one module for each, named as it; only `cli` uses them."""
