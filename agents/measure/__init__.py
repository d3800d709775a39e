"""How good a policy is: agents and baselines play the same episodes, and means get intervals.

Others use `comparison.compare`, its tables and JSON, `episodes.play_episodes`, `suites` (where
episodes begin), `baselines.make_baseline`, `policy.Policy` and `intervals`.
"""
