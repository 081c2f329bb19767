from __future__ import annotations

import json
from pathlib import Path

import pytest
from nispcodec_web.server import PageServer

from tests.cli.conftest import done, nisp, refused


def test_a_page_is_written_whole_and_not_over_another(model: Path, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    assert "page.html" in done("view", model, "-o", page).stdout
    assert "<title>tiny.nisp</title>" in page.read_text()
    refused(nisp("view", model, "-o", page), "page.html", "--force")
    told = json.loads(done("view", model, "-o", page, "--force", "--json").stdout)
    assert told == {"file": str(page), "bytes": page.stat().st_size}


def test_the_original_is_put_beside_it(model: Path, mesh: Path, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    done("view", model, "-o", page, "--original", mesh)
    assert '"positions"' in page.read_text()


def test_a_file_that_is_none_is_refused(model: Path, mesh: Path, tmp_path: Path) -> None:
    refused(nisp("view", mesh, "-o", tmp_path / "page.html"), "no .nisp file")
    refused(nisp("view", model, "-o", tmp_path / "page.txt"), ".html")
    refused(nisp("view", model, "--original", tmp_path / "none.obj"), "none.obj")


@pytest.mark.parametrize("quiet", [True, False])
def test_it_serves_until_it_is_interrupted(
    quiet: bool, model: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []

    def interrupted(server: PageServer) -> None:
        assert b"tiny.nisp" in server.page
        raise KeyboardInterrupt

    monkeypatch.setattr(PageServer, "serve_forever", interrupted)
    monkeypatch.setattr("webbrowser.open", opened.append)
    result = done("view", model, *(["--no-browser"] if quiet else []))
    address = result.stdout.split()[0]
    assert address.startswith("http://127.0.0.1:")
    assert opened == ([] if quiet else [address])
    assert "address" in json.loads(done("view", model, "--no-browser", "--json").stdout)
