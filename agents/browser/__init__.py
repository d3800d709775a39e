"""The page that shows the game and its agents in browsers, as one file; and its server."""

from .agents import BrowserAgent, browser_agent
from .following import FollowedRun, followed_run
from .page import make_page

__all__ = ["BrowserAgent", "FollowedRun", "browser_agent", "followed_run", "make_page"]
