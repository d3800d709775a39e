"""A step of a world: relaxation, the events in the order of time, and the lecture's procedure."""
