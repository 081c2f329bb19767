"""The whole encoder on small meshes with a short schedule: what must hold whatever the quality."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nispcodec
from nispcodec import EncodeConfig, NispError, NispModel, TexturedMesh
from nispcodec.core.cores import cores
from nispcodec.core.errors import FitError
from nispcodec.core.progress import Listener, Progress, silent
from nispcodec.core.texture import data_maps, reencode
from nispcodec.edit.texture_padding import with_padded_textures
from nispcodec.encode.config import PRESETS
from nispcodec.format import pack, unpack
from nispcodec.procedural.mug import sample_asset
from tests.encode.tunings import small
from tests.geometry.shapes import box_asset, cube, soup
from tests.tiny import field_of

pytestmark = pytest.mark.slow
SHORT = small(3000, 60, 1, 100, 30, lambda_=1e-6)


def encode(
    mesh: TexturedMesh, config: EncodeConfig | None = None, progress: Listener = silent
) -> NispModel:
    """As networks: what is a choice of forms is tested beside its code."""
    config = replace(config or EncodeConfig(), geometry="field")
    return nispcodec.encode(mesh, config, progress, SHORT)


BOXES: dict[str, tuple[NispModel, tuple[Progress, ...]]] = {}


def box(config: EncodeConfig) -> tuple[NispModel, tuple[Progress, ...]]:
    """A box as a model, and what its encode told: made once, for tests that only look at it."""
    if repr(config) not in BOXES:
        told: list[Progress] = []
        BOXES[repr(config)] = encode(box_asset(), config, told.append), tuple(told)
    return BOXES[repr(config)]


def bare(mesh: TexturedMesh) -> TexturedMesh:
    return replace(mesh, uvs=np.zeros((0, 2)), uv_faces=np.full_like(mesh.uv_faces, -1))


def test_an_asset_with_charts_and_materials() -> None:
    document = box(EncodeConfig())[0].document
    assert list(document.networks) == ["sdf", "chart", "uv"]
    assert document.materials == box_asset().materials
    assert document.frame.radius == pytest.approx(np.sqrt(3))
    assert 0 <= float(document.info["distance_error"]) < 0.5


@pytest.mark.parametrize("preset", PRESETS)
def test_a_pruned_network_has_zeros_in_the_file(preset: str) -> None:
    how = EncodeConfig(preset, prune="smallest", prune_rate={"chart": 0.6, "uv": 0.3})
    document = unpack(pack(encode(box_asset(), how).document))
    for name, rate in (("sdf", 0.0), ("chart", 0.6), ("uv", 0.3)):
        matrix = document.networks[name].tensors["weight.1"]
        assert rate - 0.01 <= (matrix == 0).mean() < rate + 0.2


def test_a_mesh_without_uv_is_geometry_alone() -> None:
    document = encode(bare(soup(cube((0, 0, 0), 1.0)))).document
    assert list(document.networks) == ["sdf"]


def test_materials_survive_without_uv() -> None:
    document = encode(bare(box_asset())).document
    assert list(document.networks) == ["sdf", "chart"]
    assert field_of(document).charts.materials.tolist() == [0, 1]


def test_the_same_input_and_seed_give_the_same_bytes(tmp_path: Path) -> None:
    again, other = (pack(encode(box_asset(), EncodeConfig(seed=seed)).document) for seed in (0, 1))
    first = pack(box(EncodeConfig())[0].document)
    assert first == again
    assert first != other


def test_what_is_stored_is_what_was_measured(tmp_path: Path) -> None:
    model = box(EncodeConfig())[0]
    nispcodec.save(model, tmp_path / "a.nisp")
    loaded = nispcodec.load(tmp_path / "a.nisp")
    points = np.random.default_rng(0).uniform(-1, 1, (100, 3))
    assert np.array_equal(loaded.sdf(points), model.sdf(points))
    assert np.array_equal(loaded.uv(points), model.uv(points))
    assert loaded.document.info == model.document.info


def test_the_paper_preset_has_the_published_networks_and_every_chart() -> None:
    document = box(EncodeConfig("paper"))[0].document
    counts = {name: network.spec.weight_count for name, network in document.networks.items()}
    assert counts == {"sdf": 31_169, "chart": 31_104 + 65 * 6, "uv": 31_874}


def test_textures_stay_are_padded_reencoded_or_left_out() -> None:
    looks = sample_asset()
    mesh = replace(box_asset(), materials=looks.materials, textures=looks.textures)
    kept, smaller, none = (
        encode(mesh, EncodeConfig(**options)).document
        for options in ({}, {"pad_textures": True, "texture_format": "webp"}, {"textures": False})
    )
    assert kept.textures == mesh.textures
    data = data_maps(mesh.materials)
    assert smaller.textures == reencode(with_padded_textures(mesh, 100), "webp", 90, data)
    assert {texture.mime for texture in smaller.textures} == {"image/webp"}
    assert smaller.materials == mesh.materials
    assert none.textures == ()
    assert not any(material.maps for material in none.materials)


@pytest.mark.parametrize(
    "options",
    [
        {"preset": "no"},
        {"seed": -1},
        {"seed": 1.5},
        {"threads": -1},
        {"texture_format": "foo"},
        {"texture_quality": 500},
        {"texture_quality": 0},
        {"device": "nonsense"},
        {"device": "cuda:x"},
        {"target_size": 0.0},
        {"target_error": float("nan")},
    ],
    ids=str,
)
def test_nonsense_settings_are_refused(options: dict[str, Any]) -> None:
    with pytest.raises(NispError):
        EncodeConfig(**options)


def test_stages_and_networks_are_reported() -> None:
    seen = box(EncodeConfig())[1]
    assert {progress.network for progress in seen} == {"", "sdf", "chart", "uv"}
    stages = list(dict.fromkeys(progress.stage for progress in seen if not progress.network))
    assert stages[:4] == ["textures", "charts and hidden walls", "samples", "fit"]
    assert stages[4:] == ["probe how much there is to learn", "surface"]


def test_a_device_that_is_not_there_is_an_error_before_any_work() -> None:
    told: list[Progress] = []
    with pytest.raises(FitError, match="device: expected one that torch finds here"):
        encode(box_asset(), EncodeConfig(device="cuda:99"), told.append)
    assert not told


def test_faces_the_wrong_way_round_are_told_of() -> None:
    corners = cube((0, 0, 0), 1.0)
    corners[:2] = corners[:2, ::-1]
    told: list[str] = []
    encode(bare(soup(corners)), progress=lambda update: told.append(update.warning))
    warning = next(filter(None, told))
    assert "turned faces" in warning
    assert "16.67% of the area" in warning


def test_all_stages_have_as_many_cores_as_asked() -> None:
    seen = set()
    encode(box_asset(), EncodeConfig(threads=1), lambda _: seen.add(cores()))
    assert seen == {1}
