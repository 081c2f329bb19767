"""The three.js loader and field, by their example pages in Chromium."""

from __future__ import annotations

import functools
import json
import threading
from collections.abc import Iterator
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from math import isqrt
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

from nispcodec.core.document import ChartTable, Document
from nispcodec.format import pack
from nispcodec.metrics.psnr import psnr as psnr_of_error
from nispcodec.model import NispModel
from tests import tiny
from tests.web.mesh_documents import documents
from tests.web.programs import HERE, WEB, chromium, npm_package, run_node


class Served(SimpleHTTPRequestHandler):
    """Files of web/, and the models by their paths; silent."""

    models: ClassVar[dict[str, bytes]] = {}

    def do_GET(self) -> None:
        """A model at its name, else a file."""
        if self.path not in self.models:
            super().do_GET()
            return
        self.send_response(200)
        self.send_header("Content-Length", str(len(self.models[self.path])))
        self.end_headers()
        self.wfile.write(self.models[self.path])

    def log_message(self, format: str, *args: object) -> None:
        """Nothing."""


def models() -> dict[str, Document]:
    """Fields of two kinds, one half of which is an opening, one beside a mesh; a mesh alone."""
    sphere = tiny.document(tiny.sphere(width=64))
    half = ChartTable(np.zeros(2, np.int32), np.array([True, False]), openings=True)
    opening = tiny.varied(tiny.document(), charts=half)
    mixed, copies = (documents()[name] for name in ("mixed", "copies"))
    return {
        "model": tiny.document(),
        "sphere": sphere,
        "opening": opening,
        "mixed": mixed,
        "copies": copies,
    }


@pytest.fixture
def address(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    held = {f"/three/{name}.nisp": pack(each) for name, each in models().items()}
    monkeypatch.setattr(Served, "models", held)
    handler = functools.partial(Served, directory=str(WEB))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        yield f"http://127.0.0.1:{server.server_address[1]}"
        server.shutdown()
        thread.join()


def pixels(seen: dict[str, Any]) -> Any:
    return np.array(seen["pixels"], np.uint8).reshape(seen["height"], seen["width"], 4)


@pytest.mark.slow
def test_examples_show_meshes_and_a_field_among_meshes(address: str, tmp_path: Path) -> None:
    npm_package("playwright-core")
    npm_package("three")
    said = run_node(HERE / "examples.mjs", chromium(), address, "model.nisp", timeout=900)
    found = json.loads(said)
    assert found["said"] == []
    # The octahedron of radius 0.8 in the asset's own units and place.
    meshes = found["mesh"]["meshes"]
    assert {each["material"] for each in meshes} == {"MeshStandardMaterial"}
    assert {each["name"] for each in meshes} == {"painted", "plain"}
    low = np.min([each["low"] for each in meshes], axis=0)
    high = np.max([each["high"] for each in meshes], axis=0)
    frame = tiny.document().frame
    assert np.abs((low + high) / 2 - frame.center).max() < 0.03
    assert np.abs((high - low) / 2 - 0.8 * frame.radius).max() < 0.06
    assert found["field"]["meshes"][0]["material"] == "ShaderMaterial"
    for kind in ("mesh", "field"):
        colors = pixels(found[kind])[..., :3].astype(int)
        floor = (colors[..., 2] > colors[..., 0]) & (colors[..., 0] > 30)
        # The floor covers a part of it, and it a part of the floor: depth is written.
        other = (colors.max(axis=-1) > 0) & ~floor
        assert floor.mean() > 0.05, kind
        assert other.mean() > 0.05, kind


@pytest.mark.slow
def test_the_loader_hands_over_mesh_parts(address: str, tmp_path: Path) -> None:
    npm_package("playwright-core")
    npm_package("three")
    said = run_node(HERE / "examples.mjs", chromium(), address, "copies.nisp", "mesh", timeout=900)
    found = json.loads(said)
    assert found["said"] == []
    meshes = found["mesh"]["meshes"]
    assert {each["name"] for each in meshes} == {"painted", "plain"}
    wanted = NispModel(documents()["copies"]).to_mesh().positions
    low, high = (np.array([each[end] for each in meshes]) for end in ("low", "high"))
    assert np.abs(low.min(axis=0) - wanted.min(axis=0)).max() < 1e-4
    assert np.abs(high.max(axis=0) - wanted.max(axis=0)).max() < 1e-4


@pytest.mark.slow
def test_both_renderers_draw_a_field_alike_among_meshes(address: str) -> None:
    npm_package("playwright-core")
    npm_package("three")
    names = [f"{name}.nisp" for name in ("model", "sphere", "opening", "mixed")]
    said = run_node(HERE / "field_pictures.mjs", chromium(), address, *names, timeout=900)
    found = json.loads(said)
    assert found["said"] == []
    for name, seen in found["models"].items():
        webgl = seen_by(seen.pop("webgl"))
        for kind, pictures in seen.items():
            for view, picture in seen_by(pictures).items():
                error = float(np.mean((webgl[view] - picture) ** 2))
                assert psnr_of_error(error, peak=255) >= 45, (name, kind, view)
        # Of the field the upper half is in front of the floor, the lower behind.
        whole = webgl["alone"].max(axis=-1) > 0
        in_front = np.abs(webgl["perspective"] - webgl["alone"]).max(axis=-1) <= 2
        assert 0.4 < in_front[whole].mean() < 0.8, name
    if not all("webgpu" in seen for seen in found["models"].values()):
        pytest.skip("webgpu: Chromium has no adapter; its fallback was compared")


def seen_by(pictures: dict[str, list[int]]) -> dict[str, Any]:
    """RGB of square pictures."""
    arrays = {view: np.array(pixels, float).reshape(-1, 4) for view, pixels in pictures.items()}
    return {view: each[:, :3].reshape(isqrt(len(each)), -1, 3) for view, each in arrays.items()}
