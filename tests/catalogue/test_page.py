from __future__ import annotations

import os
import re
from html.parser import HTMLParser
from pathlib import Path

from nispcodec.catalogue.histogram import histogram
from nispcodec.catalogue.page import write_page
from nispcodec.catalogue.record import DONE, Record, failed


def done(output: str, distance: float) -> Record:
    sizes = {"total": 300, "geometry_uv": 100, "input_mesh": 900, "input_textures": 200}
    errors = {"distance_error": distance}
    return Record(output, output, DONE, bytes=sizes, errors=errors, warnings=("<b>odd</b>",))


def page(folder: Path, *records: Record, viewer: str = "") -> str:
    write_page(str(folder), {each.output: each for each in records}, viewer)
    return (folder / "catalogue.html").read_text(encoding="utf-8")


class Wants(HTMLParser):
    """The places that a page would load something from."""

    def __init__(self) -> None:
        super().__init__()
        self.places: list[str] = []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.places += [value or "" for name, value in attributes if name == "src"]


def test_failures_come_first_and_texts_are_escaped(tmp_path: Path) -> None:
    text = page(
        tmp_path,
        done("a.nisp", 1e-3),
        failed("<x>.obj", "z.nisp", "crash", "died & gone"),
        done(os.fsdecode(b"caf\xe9 b.nisp"), 2e-3),
    )
    rows = re.findall(r'<tr class="(\w+)">', text)
    assert rows == ["failed", "done", "done"]
    assert "died &amp; gone" in text
    assert "&lt;b&gt;odd&lt;/b&gt;" in text
    assert 'href="caf%E9%20b.nisp"' in text
    assert "2 assets, 1 failures; 600 bytes from 2,200" in text
    assert text.count("<svg") == 3


def test_it_needs_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "a.original.webp").write_bytes(b"picture")
    text = page(tmp_path, done("a.nisp", 1e-3), viewer="https://example.org/view")
    parser = Wants()
    parser.feed(text)
    assert parser.places == ["data:image/webp;base64,cGljdHVyZQ=="]
    assert 'href="https://example.org/view?file=a.nisp"' in text
    assert "@import" not in text


def test_a_page_of_nothing_is_a_page(tmp_path: Path) -> None:
    assert "0 assets" in page(tmp_path)


def test_histograms_count_every_positive_value() -> None:
    assert histogram("none", [0.0], "") == ""
    assert histogram("one", [5.0, 5.0], "bytes").count("<rect") == 1
    text = histogram("bytes", [1.0, 10.0, 100.0], "bytes")
    assert text.count("<rect") == 3
    assert ">1 bytes<" in text
    assert ">100 bytes<" in text
