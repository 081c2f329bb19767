"""Inputs and outputs in an object store: a server of moto that speaks S3, on this machine."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("s3fs", reason="S3: pip install s3fs")
pytest.importorskip("moto.server", reason="a server of S3: pip install 'moto[server]'")

from nispcodec.catalogue.storage import joined, storage_of
from tests.catalogue.stubs import batch, meshes, ran

BUCKET = "s3://assets"


@pytest.fixture
def bucket(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A bucket; workers find its server by their environment."""
    import s3fs
    from moto.server import ThreadedMotoServer

    server = ThreadedMotoServer(port=0)
    server.start()
    _, port = server.get_host_and_port()
    monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{port}")
    monkeypatch.setenv("AWS_ACCESS_KEY_ID", "none")
    monkeypatch.setenv("AWS_SECRET_ACCESS_KEY", "none")
    monkeypatch.setenv("AWS_DEFAULT_REGION", "us-east-1")
    s3fs.S3FileSystem.clear_instance_cache()
    s3fs.S3FileSystem().mkdir("assets")
    yield BUCKET
    s3fs.S3FileSystem.clear_instance_cache()
    server.stop()


@pytest.mark.slow
def test_a_batch_from_and_to_s3_is_as_one_on_the_disk(bucket: str, tmp_path: Path) -> None:
    source = meshes(tmp_path / "in", "a", "deep/b")
    far = storage_of(bucket)
    for path in source.rglob("*.obj"):
        far.write(f"{bucket}/in/{path.relative_to(source).as_posix()}", path.read_bytes())
    near = batch(tmp_path / "near")
    ran([source], near)
    run = batch(tmp_path)
    run.folder = f"{bucket}/out"
    first = ran([f"{bucket}/in"], run)
    assert {name: each.record.status for name, each in first.items()} == {
        "a.nisp": "done",
        "deep/b.nisp": "done",
    }
    for name in first:
        assert far.read(joined(run.folder, name)) == (tmp_path / "near" / name).read_bytes()
    assert far.read(joined(run.folder, "catalogue.html"))
    assert all(each.kept for each in ran([f"{bucket}/in"], run).values())
    assert list(ran([f"{bucket}/in/deep/*.obj"], run)) == ["b.nisp"]
    far.write(f"{bucket}/in/a.obj", (source / "a.obj").read_bytes() + b"# changed\n")
    again = ran([f"{bucket}/in"], run)
    assert {name: each.kept for name, each in again.items()} == {
        "a.nisp": False,
        "deep/b.nisp": True,
    }
