from __future__ import annotations

import http.client
import threading
from collections.abc import Iterator

import pytest
from nispcodec_web.server import PageServer


@pytest.fixture
def server() -> Iterator[PageServer]:
    with PageServer("<p>ä</p>") as made:
        thread = threading.Thread(target=made.serve_forever, daemon=True)
        thread.start()
        yield made
        made.shutdown()
        thread.join()


def asked(server: PageServer, path: str, host: str) -> tuple[int, bytes]:
    connection = http.client.HTTPConnection(*server.server_address[:2])
    connection.request("GET", path, headers={"Host": host})
    answer = connection.getresponse()
    return answer.status, answer.read()


def test_it_serves_the_page_at_its_address(server: PageServer) -> None:
    assert server.address == f"http://{server.host}{server.path}"
    assert asked(server, server.path, server.host) == (200, "<p>ä</p>".encode())


def test_nothing_else_is_served(server: PageServer) -> None:
    assert asked(server, "/", server.host)[0] == 404
    assert asked(server, server.path + "x", server.host)[0] == 404
    assert asked(server, server.path, "evil.example")[0] == 404


def test_it_listens_on_this_machine_alone_and_addresses_differ(server: PageServer) -> None:
    assert server.server_address[0] == "127.0.0.1"
    with PageServer("") as other:
        assert other.path != server.path
        assert len(other.path) > 20
