"""Files dropped on the page: sound ones, others, two at once; nothing of them is left behind."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from nispcodec_web.page import original_data, viewer_page

from nispcodec.format import pack
from nispcodec.model import NispModel
from nispcodec.render.camera import Camera
from tests import tiny
from tests.web.mesh_documents import documents
from tests.web.programs import HERE, chromium, npm_package, run_node


@pytest.mark.slow
def test_the_last_sound_file_is_shown_and_nothing_is_left_of_others(tmp_path: Path) -> None:
    npm_package("playwright-core")
    document, page = tiny.document(), tmp_path / "page.html"
    original = original_data(NispModel(document).to_mesh(16), document.frame)
    page.write_text(viewer_page(pack(document), "the page's own", original))
    paths = [tmp_path / "copies.nisp", tmp_path / "mixed.nisp"]
    for path in paths:
        path.write_bytes(pack(documents()[path.stem]))
    said = run_node(HERE / "drops.mjs", chromium(), page.as_uri(), *paths, timeout=900)
    found = json.loads(said)
    assert found["bad"]["message"].startswith("0.nisp: header: signature: expected")
    assert found["bad"]["title"] == "the page's own"
    assert found["first"]["title"] == found["again"]["title"] == "0.nisp"
    assert found["first"]["message"] == found["again"]["message"] == ""
    assert found["again"]["held"] == found["first"]["held"]
    # Of two at once the later one stays, and what ended the other is no news.
    assert found["both"] == {**found["alone"], "title": "1.nisp"}
    assert found["both"]["mesh"] != found["again"]["mesh"]
    assert found["workers"] == 1
    # An arrow key in a list of choices chooses, and turns nothing.
    assert found["camera"] == Camera().elevation
    # With Shift the lamp turns, without it the camera.
    first, lit, seen = found["turned"]
    assert lit[0] == first[0] != seen[0]
    assert lit[1] == seen[1] != first[1]
    assert "reload the page" in found["lost"]
