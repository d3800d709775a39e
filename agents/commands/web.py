"""`arkanoid web`: the game and agents at play in a browser; or one file with all of it."""

import argparse
import webbrowser
from contextlib import suppress
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING

from ...envs.atomic import write_atomically
from ..experiment.errors import SettingsError
from ..experiment.files import cause, check_folder
from ..experiment.packaged import packaged_agents
from .arguments import add_trust, whole

if TYPE_CHECKING:
    from ..browser import BrowserAgent

_MOST_PORT = 65_535
_EPILOG = """\
Without --out the page is served on this computer, for this computer only, until Ctrl-C. The file of
--out needs no server, no network and nothing else: open it, mail it, or put it anywhere.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.add_argument(
        "--out", metavar="FILE.html", help="write the page to this file, and serve nothing"
    )
    parser.add_argument(
        "--model",
        metavar="RUN",
        help="also show this agent, first: the folder of a run, or a model's .zip file",
    )
    add_trust(parser)
    parser.add_argument(
        "--port", type=whole(0), metavar="N", help="where to serve (default: any that is free)"
    )
    parser.add_argument("--no-open", action="store_true", help="open no browser")
    parser.epilog = _EPILOG


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Write the page, or serve it until Ctrl-C; return the exit status."""
    out = None if arguments.out is None else Path(arguments.out)
    _check(out, arguments)
    page = packaged_page(*_own_agent(arguments.model, arguments.trust))
    if out is None:
        return _serve(page, arguments.port or 0, not arguments.no_open)
    try:
        write_atomically(out, page.encode())
    except OSError as error:
        raise SettingsError(f"{out}: cannot be written: {cause(error)}") from None
    print(out)
    return 0


def _check(out: Path | None, arguments: argparse.Namespace) -> None:
    """Raise `SettingsError` for what can't be, before anything slow is loaded."""
    if out is not None:
        if out.suffix.lower() != ".html":
            raise SettingsError(f"{out}: a page's name must end in .html")
        check_folder(out)
        if arguments.port is not None or arguments.no_open:
            raise SettingsError("--port and --no-open are of serving; with --out nothing is served")
    elif arguments.port is not None and arguments.port > _MOST_PORT:
        raise SettingsError(f"--port: at most {_MOST_PORT}, not {arguments.port}")


def packaged_page(*others: "BrowserAgent") -> str:
    """Return the page with the packaged agents, after others; HTML.

    Raises `SettingsError` where the game can't be made for browsers.
    """
    from ..browser import make_page

    taken = {agent.name for agent in others}
    # Those of the whole game first.
    names = sorted(packaged_agents(), key=lambda name: (name != "full", name))
    try:
        return make_page([*others, *(_agent(name, False) for name in names if name not in taken)])
    except ImportError as error:  # of the linker
        raise SettingsError(str(error)) from None


def _own_agent(name: str | None, trust: bool) -> "list[BrowserAgent]":
    return [] if name is None else [_agent(name, trust)]


def _agent(name: str, trust: bool) -> "BrowserAgent":
    """Return a saved agent, for the page."""
    from ..experiment.runs import ModelFile

    model = ModelFile.find(name, trust)
    experiment = model.experiment([])
    from ..browser import browser_agent

    return browser_agent(model, experiment)


def _serve(page: str, port: int, opens: bool) -> int:
    from ..browser.server import HOST, PageServer

    try:
        server = PageServer(page, port)
    except OSError as error:
        raise SettingsError(f"{HOST}:{port} cannot be served: {cause(error)}") from None
    with server:
        print(f"{server.address} (Ctrl-C ends it)", flush=True)
        if opens:
            # Browsers for terminals keep the command waiting, and wait for the page themselves.
            Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
        with suppress(KeyboardInterrupt):  # that is how one ends it
            server.serve_forever()
    return 0
