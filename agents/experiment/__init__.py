"""What a run is asked to do, and where it is kept.

Others use `errors.SettingsError`, `settings` (`Experiment` and its tables, `load_experiment`),
`reading` (settings from and to TOML), `runs` (`RunFolder`, `ModelFile`), `worlds.make_worlds`,
`provenance` and `files`.
"""
