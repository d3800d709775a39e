"""The page that shows the game and its agents in browsers, as one file; and its server."""

from .agents import BrowserAgent, browser_agent
from .page import make_page

__all__ = ["BrowserAgent", "browser_agent", "make_page"]
