"""What finds things fast: a tree of boxes, who is inside which sensor, restitutions of pairs."""
