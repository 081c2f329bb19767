"""The self-contained page: what it holds, and what it shows in Chromium."""

from __future__ import annotations

import json
import re
from base64 import b64decode
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from nispcodec_web.page import original_data, viewer_page

from nispcodec.core.arrays import Float64Array
from nispcodec.core.document import ChartTable, Document
from nispcodec.format import pack
from nispcodec.metrics.psnr import psnr as psnr_of_error
from nispcodec.model import NispModel
from nispcodec.render.camera import Camera
from nispcodec.render.channels import channel_picture
from nispcodec.render.maps import Maps
from nispcodec.render.picture import Eye
from nispcodec.render.views import scene_of
from tests import tiny
from tests.infer.parts import part_of
from tests.web.programs import HERE, chromium, npm_package, run_node

SIZE = 96


def shown(page: str, requests: list[dict[str, Any]], folder: Path) -> dict[str, Any]:
    """What browser.mjs says of a page; its pictures are in the folder."""
    npm_package("playwright-core")
    path, asked = folder / "page.html", folder / "requests.json"
    path.write_text(page)
    asked.write_text(json.dumps(requests))
    address = path.as_uri()
    said = run_node(HERE / "browser.mjs", chromium(), address, asked, folder, timeout=900)
    found: dict[str, Any] = json.loads(said)
    assert found["said"] == []
    assert found["message"] == ""
    return found


def request(name: str, **others: Any) -> dict[str, Any]:
    wanted = {"size": SIZE, "azimuth": 30, "elevation": 20, "field": False, "channel": "color"}
    return {"name": name, **wanted, **others}


def picture(folder: Path, name: str) -> Float64Array:
    """RGB over gray."""
    raw = np.frombuffer((folder / f"{name}.rgba").read_bytes(), np.uint8)
    return over_gray(raw.reshape(SIZE, SIZE, 4) / 255)


def over_gray(image: Any) -> Float64Array:
    flat: Float64Array = image[..., :3] * image[..., 3:] + 0.5 * (1 - image[..., 3:])
    return flat


def psnr(one: Float64Array, other: Float64Array) -> float:
    """In dB."""
    return psnr_of_error(float(np.mean((one - other) ** 2)), peak=1.0)


def rendered(document: Document) -> Float64Array:
    """What `nisp render` draws."""
    scene = scene_of(NispModel(document))
    return over_gray(Eye(scene, Maps(scene.textures), Camera(), SIZE).picture())


def test_a_page_is_small_and_asks_for_nothing() -> None:
    page = viewer_page(b"", "a <b> & c")
    assert len(page) < 115_000
    assert "a &lt;b&gt; &amp; c" in page
    assert "http" not in page.replace("http-equiv", "")
    policy = re.findall(r'Content-Security-Policy" content="([^"]*)"', page)
    assert len(policy) == 1
    assert policy[0].startswith("default-src 'none'; script-src 'sha256-")
    assert "unsafe-eval" not in policy[0].replace("wasm-unsafe-eval", "")
    assert "unsafe-inline" not in policy[0]


def test_data_cannot_end_the_element_that_holds_it() -> None:
    mesh = NispModel(tiny.document()).to_mesh(16)
    data = original_data(mesh, tiny.document().frame)
    data["materials"][0]["name"] = "</script><script>"
    page = viewer_page(b"", "x", data)
    assert page.count("</script>") == 4
    held = re.findall(r'id="original-data">([^<]*)<', page)
    assert json.loads(held[0])["materials"][0]["name"] == "</script><script>"


def test_an_original_is_in_the_normalized_frame() -> None:
    document = tiny.document()
    mesh = NispModel(document).to_mesh(16)
    data = original_data(mesh, document.frame)["mesh"]
    positions = np.frombuffer(b64decode(data["positions"]), np.float32).reshape(-1, 3)
    indices = np.frombuffer(b64decode(data["indices"]), np.uint32)
    assert len(indices) == 3 * len(mesh.faces) == sum(each["count"] for each in data["groups"])
    corners = document.frame.to_normalized(mesh.positions)[mesh.faces]
    ours = np.sort(positions[indices].reshape(-1, 9).astype(np.float64), axis=0)
    theirs = np.sort(corners.reshape(-1, 9).astype(np.float64), axis=0)
    assert np.abs(ours - theirs).max() < 1e-6


def documents() -> dict[str, Document]:
    """Flat faces; a sine network; one where half of the surface is an opening to look into."""
    octahedron = tiny.document()
    half = ChartTable(np.zeros(2, np.int32), np.array([True, False]), openings=True)
    return {
        "octahedron": octahedron,
        "sphere": tiny.document(tiny.sphere(width=64)),
        "opening": tiny.varied(octahedron, charts=half),
    }


@pytest.mark.slow
@pytest.mark.parametrize("name", documents())
def test_the_field_looks_as_nisp_render_draws_it(name: str, tmp_path: Path) -> None:
    document = documents()[name]
    shown(viewer_page(pack(document), name), [request("field", field=True)], tmp_path)
    assert psnr(picture(tmp_path, "field"), rendered(document)) >= 35


@pytest.mark.slow
def test_charts_have_the_colors_of_nisp_render(tmp_path: Path) -> None:
    document = tiny.document()
    shown(viewer_page(pack(document), "tiny"), [request("charts", channel="chart")], tmp_path)
    scene = scene_of(NispModel(document))
    eye = Eye(scene, Maps(scene.textures), Camera(), SIZE)
    # Most pixels are inside a chart, where samples need no mixing.
    off = np.abs(picture(tmp_path, "charts") - over_gray(channel_picture(eye, "chart")))
    assert (off.max(axis=2) < 0.01).mean() > 0.9


@pytest.mark.slow
def test_meshes_of_the_file_and_of_the_original_look_alike(tmp_path: Path) -> None:
    document = tiny.document()
    original = original_data(NispModel(document).to_mesh(128), document.frame)
    page = viewer_page(pack(document), "tiny", original)
    found = shown(page, [request("mesh"), request("original", original=True)], tmp_path)
    assert "triangles" in found["pictures"][0]["facts"]
    assert psnr(picture(tmp_path, "mesh"), rendered(document)) >= 35
    assert psnr(picture(tmp_path, "original"), picture(tmp_path, "mesh")) >= 35


@pytest.mark.slow
def test_no_line_of_the_wireframe_is_behind_its_surface(tmp_path: Path) -> None:
    asked = [request("plain"), request("lines", wireframe=True)]
    shown(viewer_page(pack(tiny.document()), "tiny"), asked, tmp_path)
    plain, lines = picture(tmp_path, "plain"), picture(tmp_path, "lines")
    # Triangles are smaller than pixels, so that everything is dark.
    seen = np.abs(plain - 0.5).max(axis=2) > 0.1
    assert seen.any()
    assert lines[seen].mean() < 0.02 * plain[seen].mean()


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["field", "triangles"])
def test_a_slice_shows_what_is_inside(kind: str, tmp_path: Path) -> None:
    field = tiny.document(tiny.sphere(width=64))
    part = part_of(np.asarray(trimesh.creation.icosphere(3, 0.6).triangles))
    document = field if kind == "field" else replace(field, field=None, meshes=(part,))
    looks = {"azimuth": 0, "elevation": 0, "channel": "distance"}
    asked = [request("middle", **looks), request("before", **looks, slice=0.9)]
    shown(viewer_page(pack(document), kind), asked, tmp_path)
    middle, before = picture(tmp_path, "middle"), picture(tmp_path, "before")
    row = middle[SIZE // 2]
    blue = np.flatnonzero(row[:, 2] > row[:, 0] + 0.02)
    assert (np.diff(blue) == 1).all()
    assert abs(len(blue) - {"field": 0.5, "triangles": 0.6}[kind] * SIZE) < 0.08 * SIZE
    assert (row[[6, -6], 0] > row[[6, -6], 2] + 0.02).all()
    disc = before[SIZE // 2, SIZE // 3 : -SIZE // 3]
    assert (disc[:, 0] > disc[:, 2] + 0.02).all()
