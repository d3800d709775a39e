"""Where the bricks lie: named levels, level files, generated levels, and the order of play."""

from .files import CAMPAIGN, Level, level_names, load_level, parse_level
from .generated import generate_level

__all__ = ["CAMPAIGN", "Level", "generate_level", "level_names", "load_level", "parse_level"]
