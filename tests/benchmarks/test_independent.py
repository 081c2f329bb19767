"""The code that checks the metrics, and what makes and fetches assets."""

from __future__ import annotations

import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
import numpy as np
import pytest

pytest.importorskip("DracoPy", reason="peers: extra `bench`")

from benchmarks.assets import fetch
from benchmarks.studies import cross_check
from benchmarks.studies.crossover import subdivided
from nispcodec.io.load import load_mesh
from nispcodec.metrics.compare import compare
from tests.metrics.shapes import joined, moved, plane, sphere


def test_closest_points_of_a_triangle_in_every_region() -> None:
    triangle = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])
    points = np.array(
        [[0.2, 0.2, 3], [-1, -1, 0], [0.5, -2, 1], [2, -0.1, 0], [1, 1, 0], [-1, 0.5, 0]]
    )
    wanted = np.array(
        [[0.2, 0.2, 0], [0, 0, 0], [0.5, 0, 0], [1, 0, 0], [0.5, 0.5, 0], [0, 0.5, 0]]
    )
    found = cross_check.closest(points, np.repeat(triangle[None], len(points), axis=0))
    assert np.allclose(found, wanted)


def test_both_implementations_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cross_check, "QUERIES", 4000)
    monkeypatch.setattr(cross_check, "CLOUD", 40_000)
    original, decoded = sphere(), sphere(subdivisions=2)
    ours = compare(original, decoded, samples=4000)["geometry"]
    theirs = cross_check.psnrs(original.corners, decoded.corners)
    assert ours["d1_psnr"] == pytest.approx(theirs["d1_psnr"], abs=0.2)
    assert ours["d2_psnr"] == pytest.approx(theirs["d2_psnr"], abs=0.2)


def test_two_charts_that_swapped_places_are_caught() -> None:
    whole = joined(plane(), moved(plane(), (1, 0, 0)))
    half = len(whole.uvs) // 2
    uvs = np.vstack([0.5 * whole.uvs[:half], 0.5 * whole.uvs[half:] + [0.5, 0]])
    original = replace(whole, uvs=uvs)
    swapped = replace(whole, uvs=np.roll(uvs, half, axis=0))
    report: dict[str, Any] = compare(original, swapped, samples=2000)
    assert report["uv"]["larger"]["median"] == pytest.approx(0.5)


def test_subdivision_keeps_uvs_on_their_corners() -> None:
    mesh = plane(cells=4)
    fine = subdivided(mesh, 2)
    assert len(fine.faces) == 16 * len(mesh.faces)
    inner = np.abs(fine.corners[..., :2] - 0.5).max(axis=(1, 2)) < 0.2
    assert inner.any()
    assert np.allclose(fine.corners[inner][..., :2], fine.corner_uvs[inner])


def test_assets_come_out_of_the_wheel_with_a_material(tmp_path: Path) -> None:
    wheel = tmp_path / "some.whl"
    text = "mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl lost\n"
    with zipfile.ZipFile(wheel, "w") as archive:
        for name in fetch.NAMES:
            folder = fetch.FOLDER.format(name=name)
            archive.writestr(f"{folder}/{name}_1k.obj", text + "f 1/1 2/2 3/3\n")
            image = sphere().textures[0].data
            archive.writestr(f"{folder}/textures/{name}_diff_1k.png", image)
    paths = fetch.unpack(wheel, tmp_path / "assets")
    mesh = load_mesh(paths[0])
    assert len(mesh.faces) == 1
    assert mesh.materials[0].maps["base_color"].texture == 0


def test_another_wheel_than_expected_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "reachy.whl").write_bytes(b"not it")
    done = type("Done", (), {"returncode": 0, "stderr": ""})
    monkeypatch.setattr("subprocess.run", lambda *_, **__: done)
    with pytest.raises(click.ClickException, match="expected SHA-256"):
        fetch.download(tmp_path)
