"""What a player is told of a world: numbers, planes or pictures, written in place."""
