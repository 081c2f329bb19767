"""One page on a web server of this machine alone."""

from __future__ import annotations

import secrets
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

LOOPBACK = "127.0.0.1"


class PageServer(ThreadingHTTPServer):
    """Serves a page on a free port of the loopback interface, at an address with a secret in it.

    Other programs and other pages of the browser do not know the address, and a name that was made
    to point here (DNS rebinding) is refused. `serve_forever` runs it.
    """

    daemon_threads = True

    def __init__(self, page: str) -> None:
        super().__init__((LOOPBACK, 0), _Handler)
        self.page = page.encode()
        self.path = f"/{secrets.token_urlsafe(16)}/"

    @property
    def address(self) -> str:
        """Where a browser finds the page."""
        return f"http://{self.host}{self.path}"

    @property
    def host(self) -> str:
        """What browsers send as the name of the host."""
        return f"{LOOPBACK}:{self.server_address[1]}"


class _Handler(BaseHTTPRequestHandler):
    server: PageServer

    def do_GET(self) -> None:
        """The page at its address; 404 for anything else."""
        known = secrets.compare_digest(self.path.encode(), self.server.path.encode())
        if not known or self.headers.get("Host") != self.server.host:
            self.send_error(404)
            return
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(self.server.page)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("Referrer-Policy", "no-referrer")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.end_headers()
        self.wfile.write(self.server.page)

    def log_message(self, format: str, *args: object) -> None:
        """Requests are nobody's business."""
