"""Experiments, as TOML."""
