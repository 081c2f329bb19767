"""The eight real assets beside the project, when they are there."""

from __future__ import annotations

from pathlib import Path

import pytest

from nispcodec.geometry.charts import split_charts
from nispcodec.geometry.symmetry import Symmetry
from nispcodec.geometry.welding import welded
from nispcodec.io.load import load_mesh
from tests.samplers import analysis_of

pytestmark = pytest.mark.assets
ASSETS = Path(__file__).resolve().parents[3] / "shared" / "assets"

# Faces, charts, materials, textures, maps of the first material.
EXPECTED = {
    "boombox": (6036, 20, 1, 2, {"base_color", "normal"}),
    "chess_king": (40480, 15, 1, 2, {"base_color", "normal"}),
    "exploding_barrel": (8150, 23, 1, 2, {"base_color", "normal"}),
    "flight_helmet": (94722, 237, 6, 10, {"base_color", "normal"}),
    "food_apple_01": (7012, 13, 1, 1, {"base_color"}),
    "gz_polaris": (7714, 354, 1, 1, {"base_color"}),
    "spot": (5856, 13, 1, 1, {"base_color"}),
    "tea_set_01": (40296, 44, 1, 2, {"base_color", "normal"}),
}


@pytest.mark.parametrize("name", EXPECTED)
def test_real_asset(name: str) -> None:
    path = ASSETS / name / f"{name}.obj"
    if not path.exists():
        pytest.skip(f"no asset {path}")
    mesh = load_mesh(path)
    found = (
        len(mesh.faces),
        len(split_charts(mesh, welded(mesh))),
        len(mesh.materials),
        len(mesh.textures),
        set(mesh.materials[0].maps),
    )
    assert found == EXPECTED[name]
    assert mesh.warnings == ()
    assert mesh.has_uv.all()
    originals = {image.read_bytes() for image in path.parent.iterdir()}
    assert {texture.data for texture in mesh.textures} <= originals


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("spot", Symmetry(sdf=0b000001, uv=0)),
        ("exploding_barrel", Symmetry(sdf=0b100101, uv=0)),
        ("chess_king", Symmetry(sdf=0b000101, uv=0)),
        ("boombox", Symmetry(sdf=0b001001, uv=0)),
        ("gz_polaris", Symmetry(sdf=0b001001, uv=0b001001)),
        ("tea_set_01", Symmetry(sdf=0, uv=0)),
    ],
)
def test_symmetry_of_real_assets(name: str, expected: Symmetry) -> None:
    path = ASSETS / name / f"{name}.obj"
    if not path.exists():
        pytest.skip(f"no asset {path}")
    assert analysis_of(load_mesh(path)).symmetry == expected
