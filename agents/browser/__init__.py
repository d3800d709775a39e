"""The page that shows the game and its agents in browsers, as one file; and its server."""

from .page import BrowserAgent, make_page

__all__ = ["BrowserAgent", "make_page"]
