"""`nisp info`: maps by slot, factors, and what the encode says of itself."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from nispcodec.core.asset import Material, Texture, TextureMap
from nispcodec.core.document import Document
from nispcodec.format import pack
from tests import tiny
from tests.cli.conftest import done

INFO: dict[str, str | int | float | bool] = {
    "preset": "fast",
    "seed": 7,
    "distance_error": 4.4e-4,
    "uv_error_mean": 1e-3,
}


def document() -> Document:
    """A material with every factor, another without a map, and a damaged image."""
    first = tiny.document()
    shiny = Material(
        "shiny",
        base_color=(0.5, 0.25, 1.0, 0.75),
        metallic=0.9,
        roughness=0.2,
        emissive=(0.0, 1.0, 0.5),
        alpha_mode="mask",
        alpha_cutoff=0.3,
        double_sided=True,
        maps={
            "base_color": TextureMap(0, wrap=("clamp", "mirror"), filter="nearest"),
            "normal": TextureMap(1, strength=0.7),
        },
    )
    broken = Texture("broken.png", b"no image", "image/png")
    return replace(
        first,
        materials=(shiny, first.materials[1]),
        textures=(first.textures[0], broken),
        info=INFO,
    )


@pytest.fixture
def shiny(tmp_path: Path) -> Path:
    path = tmp_path / "shiny.nisp"
    path.write_bytes(pack(document()))
    return path


def test_factors_and_maps_as_json(shiny: Path) -> None:
    found = json.loads(done("info", shiny, "--json").stdout)["materials"]
    size = len(document().textures[0].data)
    assert found[0] == {
        "name": "shiny",
        "base_color": [0.5, 0.25, 1.0, 0.75],
        "metallic": pytest.approx(0.9),
        "roughness": pytest.approx(0.2),
        "emissive": [0.0, 1.0, 0.5],
        "alpha_mode": "mask",
        "alpha_cutoff": pytest.approx(0.3),
        "double_sided": True,
        "maps": {
            "base_color": {
                "texture": 0,
                "image": "tiny.png",
                "mime": "image/png",
                "bytes": size,
                "pixels": "2 x 2",
                "wrap": ["clamp", "mirror"],
                "filter": "nearest",
                "strength": 1.0,
            },
            "normal": {
                "texture": 1,
                "image": "broken.png",
                "mime": "image/png",
                "bytes": 8,
                "pixels": "unreadable",
                "wrap": ["repeat", "repeat"],
                "filter": "linear",
                "strength": pytest.approx(0.7),
            },
        },
    }
    assert found[1]["maps"] == {}
    assert "alpha_cutoff" not in found[1]


def spoken(path: Path) -> list[str]:
    """The lines, with single spaces."""
    return [" ".join(line.split()) for line in done("info", path).stdout.splitlines()]


def test_factors_and_maps_for_people(shiny: Path) -> None:
    said = spoken(shiny)
    size = len(document().textures[0].data)
    for line in (
        "base_color 0.5, 0.25, 1, 0.75",
        "metallic 0.9",
        "roughness 0.2",
        "emissive 0, 1, 0.5",
        "alpha_mode mask",
        "alpha_cutoff 0.3",
        "double_sided yes",
        f"base_color tiny.png, 2 x 2 pixels, image/png, {size} bytes",
        "normal broken.png, unreadable pixels, image/png, 8 bytes",
        "maps none",
    ):
        assert line in said


def test_what_the_encode_says_of_itself(shiny: Path) -> None:
    said = spoken(shiny)
    after = said[said.index("encoded with") :]
    assert after[:3] == ["encoded with", "preset fast", "seed 7"]
    assert after[3:] == ["measured", "distance_error 0.00044", "uv_error_mean 0.001"]
    assert json.loads(done("info", shiny, "--json").stdout)["measured"] == INFO


def test_a_file_that_says_nothing_of_itself(model: Path) -> None:
    assert spoken(model)[-2:] == ["encoded with not told", "measured not told"]
