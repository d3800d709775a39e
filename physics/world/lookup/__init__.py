"""What finds things fast: a tree and a grid of boxes, who is inside which sensor, restitutions."""
