from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("DracoPy", reason="peers: extra `bench`")

import nispcodec
from benchmarks.assets import simplify_update
from benchmarks.assets.corners import corners_of
from benchmarks.assets.simplify import simplified
from benchmarks.assets.source import Source
from benchmarks.codecs import CODECS, Setting, Unavailable, codec, gltfpack
from benchmarks.rate_distortion.bjontegaard import LEAST_POINTS
from nispcodec.core.asset import TexturedMesh
from nispcodec.encode.config import PRESETS, EncodeConfig
from nispcodec.format import pack
from nispcodec.io.save import write_mesh
from nispcodec.model import NispModel
from nispcodec.procedural.mug import sample_asset
from tests.tiny import document


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Source:
    path = tmp_path_factory.mktemp("asset") / "mug.obj"
    write_mesh(sample_asset(), path)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("benchmarks.assets.source.SAMPLES", 4000)
        made = Source(path)
        assert made.reference.samples == 4000
    return made


PROTECTED: Setting = {"seams": "protected"}
HALF: Setting = {"surface": "all", "kept": 0.5, "qp": 11, "qt": 10}
MOVED = HALF | PROTECTED | {"uv_weight": 10.0}
# Codec -> setting and the largest mean distance and UV error that its bits explain.
EXPECTED: dict[str, tuple[Setting, float, float]] = {
    "obj": ({"text": "as it is"}, 1e-12, 1e-3),
    "obj_xz": ({"text": "4 digits"}, 3e-4, 1e-3),
    "obj_zst": ({"text": "4 digits"}, 3e-4, 1e-3),
    "glb": ({}, 1e-6, 1e-3),
    "draco": ({"qp": 11, "qt": 10}, 5e-4, 2e-3),
    "simplified_draco": (HALF, 3e-3, 2e-2),
    "simplified_update_draco": (
        MOVED,
        3e-3,
        2e-2,
    ),
    "simplified_update_meshopt": (
        MOVED,
        3e-3,
        2e-2,
    ),
    "simplified_gltfpack": (
        {"compression": "cz", "vp": 14, "vt": 12, "kept": 0.5, "seams": "protected"},
        3e-3,
        2e-2,
    ),
    "gltfpack": ({"compression": "cc", "vp": 14, "vt": 12}, 1e-4, 1e-3),
}


FROM_NPM = {"gltfpack", *(name for name in CODECS if name.startswith("simplified_update"))}
FROM_NPM.add("simplified_gltfpack")


@pytest.mark.parametrize("name", EXPECTED)
def test_what_comes_back_is_as_close_as_the_bits_allow(name: str, source: Source) -> None:
    setting, distance, uv = EXPECTED[name]
    coder = codec(name)
    try:
        coder.settings(source, quick=True)
        data = coder.encode(source, setting)
    except Unavailable as why:
        pytest.skip(str(why))  # The adapter names the tool that this machine lacks.
    decoded = coder.decode(data, source)
    assert decoded.materials == source.mesh.materials
    report: dict[str, Any] = source.reference.compare(decoded)
    assert report["geometry"]["larger"]["mean"] <= distance
    assert report["uv"]["larger"]["mean"] <= uv


def test_several_materials_survive_draco(source: Source) -> None:
    draco = codec("draco")
    decoded = draco.decode(draco.encode(source, {"qp": 11, "qt": 10}), source)
    counts = [np.bincount(mesh.face_materials).tolist() for mesh in (source.mesh, decoded)]
    assert counts[0] == counts[1]
    assert len(counts[0]) > 1


def test_more_bits_cost_more_and_lose_less(source: Source) -> None:
    draco = codec("draco")
    files = [draco.encode(source, {"qp": bits, "qt": bits}) for bits in (8, 10, 12)]
    reports: list[Any] = [source.reference.compare(draco.decode(data, source)) for data in files]
    errors = [report["geometry"]["larger"]["mean"] for report in reports]
    assert len(files[0]) < len(files[1]) < len(files[2])
    assert errors[0] > errors[1] > errors[2]


def test_simplification_reaches_the_asked_count_on_the_given_vertices(source: Source) -> None:
    pytest.importorskip("meshoptimizer", reason="extra `simplify`")
    corners = corners_of(source.mesh)
    fewer = simplified(corners, len(corners.faces) // 4)
    assert len(fewer.faces) <= len(corners.faces) // 4
    known = {tuple(row) for row in np.hstack([corners.positions, corners.uvs]).tolist()}
    assert {tuple(row) for row in np.hstack([fewer.positions, fewer.uvs]).tolist()} <= known


def test_gltfpack_tells_when_it_is_missing(source: Source, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda name: None)
    monkeypatch.setattr(gltfpack, "LOCAL", Path("nowhere"))
    with pytest.raises(Unavailable, match="npm install gltfpack"):
        gltfpack.settings(source, quick=False)


def test_moving_vertices_tell_what_is_missing(
    source: Source, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    moving = codec("simplified_update_draco")
    monkeypatch.setattr("shutil.which", lambda name: "/usr/bin/node")
    monkeypatch.setattr(simplify_update, "PACKAGE", tmp_path)
    with pytest.raises(Unavailable, match=r"npm install meshoptimizer@1.3.0"):
        moving.settings(source, quick=False)
    (tmp_path / "package.json").write_text('{"version": "1.2.0"}')
    with pytest.raises(Unavailable, match=r"expected meshoptimizer 1.3.0 in .*, found 1.2.0"):
        moving.settings(source, quick=False)
    monkeypatch.setattr("shutil.which", lambda name: None)
    with pytest.raises(Unavailable, match="node is not installed"):
        moving.settings(source, quick=False)


def test_every_weight_has_every_count(
    source: Source, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    pytest.importorskip("meshoptimizer", reason="extra `simplify`")
    (tmp_path / "package.json").write_text('{"version": "1.3.0"}')
    monkeypatch.setattr("shutil.which", lambda name: "/usr/bin/node")
    monkeypatch.setattr(simplify_update, "PACKAGE", tmp_path)
    settings = codec("simplified_update_draco").settings(source, quick=True)
    assert {setting["uv_weight"] for setting in settings} == {1.0, 10.0, 100.0}
    assert {setting["seams"] for setting in settings} == {"protected", "permissive"}
    assert len({str(setting) for setting in settings}) == len(settings)


@pytest.mark.parametrize("name", sorted(set(CODECS) - FROM_NPM))
def test_a_quick_run_has_fewer_settings(name: str, source: Source) -> None:
    if name == "simplified_draco":
        pytest.importorskip("meshoptimizer", reason="extra `simplify`")
    quick, full = (codec(name).settings(source, quick) for quick in (True, False))
    assert 1 <= len(quick) <= len(full)
    assert all(setting in full for setting in quick)


def test_simplified_to_nothing_is_an_error_that_says_so(source: Source) -> None:
    pytest.importorskip("meshoptimizer", reason="extra `simplify`")
    setting: Setting = {"surface": "all", "kept": 0.0, "qp": 11, "qt": 10}
    with pytest.raises(ValueError, match="found none left"):
        codec("simplified_draco").encode(source, setting)


def test_a_decoded_model_shows_the_source_s_materials(source: Source) -> None:
    decoded = codec("nisp").decode(pack(document()), source)
    assert decoded.materials == source.mesh.materials
    assert decoded.textures == source.mesh.textures
    assert len(decoded.faces) > 0


def test_the_paper_s_preset_runs_only_when_asked_for(source: Source) -> None:
    ours, theirs = (
        {setting["preset"] for setting in codec(name).settings(source, quick=False)}
        for name in ("nisp", "nisp_paper")
    )
    assert ours == {*PRESETS} - {"paper"}
    assert theirs == {"paper"}


def test_our_curve_has_the_points_that_a_delta_rate_wants(source: Source) -> None:
    settings = codec("nisp").settings(source, quick=False)
    assert len(settings) >= LEAST_POINTS
    sized = {setting["preset"] for setting in settings if "target_size" in setting}
    assert sized == {EncodeConfig().preset}


@pytest.mark.parametrize("name", ["nisp", "nisp_paper"])
def test_the_encoder_knows_our_settings(
    name: str, source: Source, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[EncodeConfig] = []

    def encode(mesh: TexturedMesh, config: EncodeConfig) -> NispModel:
        asked.append(config)
        return NispModel(document())

    monkeypatch.setattr(nispcodec, "encode", encode)
    for setting in codec(name).settings(source, quick=False):
        codec(name).encode(source, setting)
    assert not any(config.textures for config in asked)
    assert len({repr(config) for config in asked}) == len(asked)
