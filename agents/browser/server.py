"""A server of one page, for browsers on this computer; and of the run that the page follows."""

import json
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from .following import FollowedRun

HOST = "127.0.0.1"
# Nothing of another place is loaded, whatever the page's data say.
_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; "
    "style-src 'unsafe-inline'; img-src data: blob:; connect-src 'self'; "
    "form-action 'none'; frame-ancestors 'self'"
)


# Where the page finds what its run says by now, and the latest agent: see `FollowedRun`.
NEWS = "/run.json"
NETWORK = "/agent"


class PageServer(ThreadingHTTPServer):
    """Serves a page under ``/`` to this computer only, and beside it a run, if there is one.

    Args:
        page: HTML.
        port: 0 for any that is free.
        run: which the page follows.

    Raises:
        OSError: the port is taken, or may not be used.
    """

    daemon_threads = True

    def __init__(self, page: str, port: int, run: FollowedRun | None = None) -> None:
        self._page = page.encode()
        self._run = run
        super().__init__((HOST, port), _Handler)

    @property
    def address(self) -> str:
        """What a browser is given."""
        return f"http://{HOST}:{self.port}/"

    @property
    def port(self) -> int:
        """Where it is served."""
        return int(self.server_address[1])

    def find(self, place: str) -> tuple[str, bytes] | None:
        """Return the type and the content of what is served at a place; None if nothing is."""
        if place == "/":
            return "text/html; charset=utf-8", self._page
        if self._run is None:
            return None
        if place == NEWS:
            return "application/json", json.dumps(self._run.news()).encode()
        network = self._run.network() if place == NETWORK else None
        return None if network is None else ("application/octet-stream", network)


class _Handler(BaseHTTPRequestHandler):
    def do_GET(self) -> None:
        """Send what is asked for."""
        self._send(with_content=True)

    def do_HEAD(self) -> None:
        """Send what would stand before it."""
        self._send(with_content=False)

    def log_message(self, format: str, *args: Any) -> None:  # noqa: A002
        """Print nothing: the terminal shows the address."""

    def _send(self, with_content: bool) -> None:
        assert isinstance(self.server, PageServer)
        found = self.server.find(self.path.partition("?")[0])
        if found is None:
            self.send_error(404)
            return
        kind, content = found
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Content-Security-Policy", _POLICY)
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        if with_content:
            self.wfile.write(content)
