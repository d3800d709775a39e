"""What is where: the bodies that a shape overlaps, and what a ray meets first."""
