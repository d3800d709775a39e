"""Two bodies that meet: when and where, whether they bounce, and what is written down of it."""
