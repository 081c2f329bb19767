"""The page shows files of triangles, and those that have a field beside them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from nispcodec_web.page import viewer_page

from nispcodec.core.mesh_part import Placement
from nispcodec.format import pack
from tests.infer import parts
from tests.web.mesh_documents import document, documents
from tests.web.test_page import picture, psnr, rendered, request, shown


@pytest.mark.slow
@pytest.mark.parametrize("name", ["copies", "encoded", "overlapping"])
def test_a_mesh_looks_as_nisp_render_draws_it(name: str, tmp_path: Path) -> None:
    """In the field's view too, as there is no field."""
    made = documents()[name]
    asked = [request("mesh"), request("field", field=True)]
    found = shown(viewer_page(pack(made), name), asked, tmp_path)
    assert "triangles" in found["pictures"][0]["facts"]
    assert psnr(picture(tmp_path, "mesh"), rendered(made)) >= 30
    assert psnr(picture(tmp_path, "field"), picture(tmp_path, "mesh")) >= 50


@pytest.mark.slow
def test_a_field_and_a_mesh_hide_each_other(tmp_path: Path) -> None:
    """The mesh's and the field's view show the same: a cube that an octahedron's corners leave."""
    cube = parts.part_of(parts.cube(0.55), placements=(Placement(offset=(0.1, 0.05, 0.0)),))
    made = document(cube, fitted=True)
    asked = [request("mesh"), request("field", field=True)]
    shown(viewer_page(pack(made), "mixed"), asked, tmp_path)
    assert psnr(picture(tmp_path, "mesh"), rendered(made)) >= 30
    assert psnr(picture(tmp_path, "field"), picture(tmp_path, "mesh")) >= 30
    alone = replace(made, meshes=())
    shown(viewer_page(pack(alone), "alone"), [request("alone", field=True)], tmp_path)
    assert psnr(picture(tmp_path, "field"), picture(tmp_path, "alone")) < 25
