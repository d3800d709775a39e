"""Two bodies and all that the engine says of them, as one record: for pages that teach."""
