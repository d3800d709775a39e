"""A server of one page, for browsers on this computer."""

from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

HOST = "127.0.0.1"
# Nothing of another place is loaded, whatever the page's data say.
_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; "
    "style-src 'unsafe-inline'; img-src data: blob:; form-action 'none'; frame-ancestors 'self'"
)


class PageServer(ThreadingHTTPServer):
    """Serves a page under ``/`` to this computer only.

    Args:
        page: HTML.
        port: 0 for any that is free.

    Raises:
        OSError: the port is taken, or may not be used.
    """

    daemon_threads = True

    def __init__(self, page: str, port: int) -> None:
        self.content = page.encode()
        super().__init__((HOST, port), _Handler)

    @property
    def address(self) -> str:
        """What a browser is given."""
        return f"http://{HOST}:{self.server_address[1]}/"


class _Handler(BaseHTTPRequestHandler):
    def do_GET(self) -> None:
        """Send the page."""
        self._send(with_content=True)

    def do_HEAD(self) -> None:
        """Send what would stand before the page."""
        self._send(with_content=False)

    def log_message(self, format: str, *args: Any) -> None:  # noqa: A002
        """Print nothing: the terminal shows the address."""

    def _send(self, with_content: bool) -> None:
        assert isinstance(self.server, PageServer)
        content = self.server.content
        if self.path.partition("?")[0] != "/":
            self.send_error(404)
            return
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Content-Security-Policy", _POLICY)
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        if with_content:
            self.wfile.write(content)
