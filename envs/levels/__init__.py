"""Where the bricks lie: named levels, level files, generated levels, and their order."""
