"""`arkanoid web`: the game and agents at play in a browser; or one file with all of it."""

import argparse
import os
import socket
import webbrowser
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Any

from ...envs.atomic import write_atomically
from ..experiment.errors import SettingsError
from ..experiment.files import cause, check_folder
from ..experiment.packaged import packaged_agents
from ..experiment.programs import command
from .arguments import add_trust, whole

if TYPE_CHECKING:
    from ..browser import BrowserAgent, FollowedRun
    from ..browser.server import PageServer
_MOST_PORT = 65_535
_EPILOG = """\
Without --out the page is served on this computer, for this computer only, until Ctrl-C. If RUN is a
folder, the page follows the run while that is trained: its curves, and its latest agent. The file
of --out needs no server, no network and nothing else: open it, mail it, or put it anywhere.
"""


@dataclass(frozen=True)
class Wanted:
    """What the page shows of one agent.

    Attributes:
        model: as `ModelFile.find` takes it; the folder of a run need have no model yet.
        trust: whether its author is trusted.
        overrides: of its settings.
        level: what it plays at first; None: what it was trained on.
    """

    model: str | None
    trust: bool
    overrides: Sequence[tuple[str, str]] = ()
    level: str | None = None


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
    add_serving(parser)
    parser.epilog = _EPILOG


def add_serving(parser: argparse.ArgumentParser) -> None:
    """Add the options that say how the page is served."""
    parser.add_argument(
        "--port", type=whole(0), metavar="N", help="where to serve (default: any that is free)"
    )
    parser.add_argument("--no-open", action="store_true", help="open no browser")


def run(arguments: argparse.Namespace, overrides: list[tuple[str, str]]) -> int:
    """Write the page, or serve it until Ctrl-C; return the exit status."""
    wanted = None
    if arguments.model is not None:
        wanted = Wanted(arguments.model, arguments.trust)
    if arguments.out is None:
        return serve(arguments, wanted)
    out = Path(arguments.out)
    _check_file(out, arguments)
    page, _ = make(wanted, served=False)
    try:
        write_atomically(out, page.encode())
    except OSError as error:
        raise SettingsError(f"{out}: cannot be written: {cause(error)}") from None
    print(out)
    return 0


def serve(arguments: argparse.Namespace, wanted: Wanted | None) -> int:
    """Serve the page until Ctrl-C, as the arguments of `add_serving` say; return the exit status.

    With an agent it opens where agents are watched.
    """
    port = arguments.port or 0
    if port > _MOST_PORT:
        raise SettingsError(f"--port: at most {_MOST_PORT}, not {port}")
    page, run = make(wanted, served=True)
    server = open_server(page, port, run)
    with server:
        print(f"{server.address} (Ctrl-C ends it)", flush=True)
        if arguments.no_open or "SSH_CONNECTION" in os.environ:
            print(_tunnel(server.port), flush=True)
        if not arguments.no_open:
            # Browsers for terminals keep the command waiting, and wait for the page themselves.
            Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
        with suppress(KeyboardInterrupt):  # that is how one ends it
            server.serve_forever()
    return 0


def open_server(page: str, port: int, run: "FollowedRun | None") -> "PageServer":
    """Return the server of a page, and of the run that it follows.

    Raises `SettingsError` if the port cannot be used.
    """
    from ..browser.server import HOST, PageServer

    try:
        return PageServer(page, port, run)
    except OSError as error:
        raise SettingsError(f"{HOST}:{port} cannot be served: {cause(error)}") from None


def packaged_page() -> str:
    """Return the page with the packaged agents; HTML.

    Raises `SettingsError` where the game can't be made for browsers.
    """
    return make(None, served=False)[0]


def _check_file(out: Path, arguments: argparse.Namespace) -> None:
    """Raise `SettingsError` if there can be no such file, before anything slow is loaded."""
    if out.suffix.lower() != ".html":
        raise SettingsError(f"{out}: a page's name must end in .html")
    check_folder(out)
    if arguments.port is not None or arguments.no_open:
        raise SettingsError("--port and --no-open are of serving; with --out nothing is served")


def make(wanted: Wanted | None, served: bool) -> "tuple[str, FollowedRun | None]":
    """Return the page, HTML; and the run that it follows or shows, if it does.

    Raises `SettingsError` for what is wrong with the agent, and where the game can't be made for
    browsers.
    """
    from ...envs.browser.shipped import offers_module

    if not offers_module():  # before the agents are compiled
        raise _without_linker()
    agents: list[BrowserAgent] = []
    run, asked = None, None
    if wanted is not None:
        agent, run, asked = _find(wanted, served)
        agents.append(agent)
    from ..browser import make_page

    # Those of the whole game first.
    names = sorted(packaged_agents(), key=lambda name: (name != "full", name))
    others = [name for name in names if name not in {agent.name for agent in agents}]
    agents += [_find(Wanted(name, trust=False), served)[0] for name in others]
    shown = None if run is None else {"live": served, "news": run.news()}
    try:
        return make_page(agents, "watch" if wanted else "play", shown, asked), run
    except ImportError as error:  # the module that came with the package is of other sources
        raise _without_linker() from error


def _without_linker() -> SettingsError:
    """Return the error where the game can't be made for browsers."""
    install = f'{command("pip", "install", "-e")} ".[web]"'
    return SettingsError(
        f"to make the page needs the linker wasm-ld: run `{install}` in arkanoid's repository, "
        f"or install Debian's package lld"
    )


def _find(
    wanted: Wanted, served: bool
) -> "tuple[BrowserAgent, FollowedRun | None, dict[str, Any] | None]":
    """Return an agent for the page, its run if that is a folder, and the levels it plays."""
    from ..experiment.runs import ModelFile

    overrides, run = list(wanted.overrides), None
    if wanted.model is not None and Path(wanted.model).is_dir():
        from ..browser import BrowserAgent, followed_run

        run = followed_run(Path(wanted.model), wanted.trust, overrides)
        experiment = run.experiment
        # Who is served asks for the latest one.
        network = None if served else run.network()
        if not served and network is None:
            raise SettingsError(f"{wanted.model}: {run.news()['agent']}")
        agent = BrowserAgent(experiment.name, experiment.game, network)
    else:
        model = ModelFile.find(wanted.model, wanted.trust)
        experiment = model.experiment(overrides)
        from ..browser import browser_agent

        agent = browser_agent(model, experiment)
    if wanted.level is None:
        return agent, run, None
    from ..browser.levels import asked_levels

    return agent, run, asked_levels(experiment, wanted.level)


def _tunnel(port: int) -> str:
    """Return how one gets to the page from another computer."""
    from ..browser.server import HOST

    tunnel = f"ssh -L {port}:{HOST}:{port} {socket.gethostname()}"
    return f"from another computer: {tunnel}, then the same address"
