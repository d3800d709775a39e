"""The packaged experiments and search spaces, as TOML files."""
