from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import nispcodec
from nispcodec.catalogue.inputs import sha256
from nispcodec.catalogue.job import Job
from nispcodec.catalogue.record import BUG, DISK, INPUT, MEMORY, STORAGE
from nispcodec.catalogue.settings import Settings
from nispcodec.catalogue.work import encoder, work
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import NispError
from nispcodec.core.progress import Listener
from nispcodec.encode.config import EncodeConfig
from nispcodec.format import pack
from nispcodec.model import NispModel
from tests import tiny
from tests.catalogue.stubs import document, job, meshes, quick


@pytest.fixture
def one(tmp_path: Path) -> Job:
    return job(meshes(tmp_path / "in", "a") / "a.obj", tmp_path / "out")


def test_the_output_is_that_of_the_encoder_and_the_record_says_all(one: Job) -> None:
    result = work(replace(one, thumbnail=32, tries=2), quick)
    record, place = result.record, Path(one.folder) / "a.nisp"
    data = place.read_bytes()
    mesh = nispcodec.load_mesh(one.asset.source)
    assert data == pack(document(mesh))
    assert (record.status, record.sha256, record.tries) == ("done", sha256(data), 2)
    assert (
        record.bytes["total"]
        == len(data)
        == sum(record.bytes[name] for name in ("geometry_uv", "textures"))
    )
    assert record.bytes["input_mesh"] == Path(one.asset.source).stat().st_size
    assert record.warnings == ("a: a warning",)
    assert 0 <= record.seconds["encode"] <= record.seconds["all"]
    assert {each.name for each in place.parent.iterdir()} == {
        "a.nisp", "a.original.webp", "a.decoded.webp",
    }  # fmt: skip


def test_it_is_asked_as_nisp_encode_asks(one: Job, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[Any] = []

    def encode(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
        seen.append(config)
        return NispModel(tiny.document())

    monkeypatch.setattr(nispcodec, "encode", encode)
    settings = Settings(EncodeConfig(seed=4, textures=False))
    assert work(replace(one, settings=settings, threads=3), encoder).record.done
    assert seen == [EncodeConfig(seed=4, textures=False, threads=3)]


def test_what_is_done_is_kept_until_something_changes(one: Job) -> None:
    earlier = work(one, quick).record
    again = replace(one, earlier=earlier)
    place = Path(one.folder) / "a.nisp"
    assert work(again, quick).kept
    assert work(replace(again, threads=2), quick).kept
    assert not work(replace(again, settings=Settings(EncodeConfig(seed=1))), quick).kept
    work(one, quick)
    place.write_bytes(place.read_bytes()[:-1] + b"x")
    assert not work(again, quick).kept
    place.unlink()
    assert not work(again, quick).kept
    Path(one.asset.source).write_text(Path(one.asset.source).read_text() + "# changed\n")
    assert not work(again, quick).kept


def raising(error: BaseException) -> Any:
    def encode(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
        raise error

    return encode


@pytest.mark.parametrize(
    ("error", "kind", "said"),
    [
        (MemoryError(), MEMORY, "--memory allows more"),
        (OSError(28, "No space left on device"), DISK, "OSError at test_work.py"),
        (ConnectionError("reset"), STORAGE, "ConnectionError at test_work.py"),
        (NispError("two\nlines"), INPUT, "two lines"),
        (KeyError("x"), BUG, "KeyError at test_work.py"),
    ],
)
def test_what_goes_wrong_is_told_by_its_kind(
    one: Job, error: BaseException, kind: str, said: str
) -> None:
    record = work(one, raising(error)).record
    assert (record.status, record.kind) == ("failed", kind)
    assert said in record.error
    assert not Path(one.folder).exists()


def test_ctrl_c_is_no_result(one: Job) -> None:
    with pytest.raises(KeyboardInterrupt):
        work(one, raising(KeyboardInterrupt()))


def test_an_output_that_does_not_verify_is_not_written(one: Job) -> None:
    broken = tiny.document()
    texture = replace(broken.textures[0], data=broken.textures[0].data[:20])

    def encode(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
        return NispModel(replace(broken, textures=(texture,)))

    record = work(one, encode).record
    assert record.kind == INPUT
    assert "an image that decodes" in record.error
    assert not Path(one.folder).exists()


def test_a_decode_is_measured_if_asked_for(one: Job, tmp_path: Path) -> None:
    """The encoder gives the octahedron that the mesh is of."""
    path = tmp_path / "in" / "octahedron.obj"
    NispModel(tiny.document()).to_mesh(24).save(path)
    asked = replace(one, asset=replace(one.asset, source=str(path)), compare=True)
    errors = work(asked, raising_nothing).record.errors
    assert errors["decoded_distance_mean"] < 0.05
    assert {"decoded_distance_p99", "decoded_color_psnr"} <= set(errors)


def raising_nothing(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
    return NispModel(tiny.document())


def test_unwrapping_comes_first(one: Job) -> None:
    pytest.importorskip("xatlas", reason="new UVs: extra `unwrap`")
    seen: list[TexturedMesh] = []

    def encode(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
        seen.append(mesh)
        return NispModel(tiny.document())

    assert work(replace(one, settings=Settings(unwrap=True)), encode).record.done
    assert seen[0].has_uv.all()


def test_a_folder_that_cannot_be_written_is_told(one: Job) -> None:
    Path(one.folder).write_text("a file is in the way")
    record = work(one, quick).record
    assert record.kind == STORAGE
    assert os.path.exists(one.folder)  # noqa: PTH110
