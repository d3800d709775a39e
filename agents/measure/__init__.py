"""How good a policy is: the same games for agents and baselines, with intervals."""
