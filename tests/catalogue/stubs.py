"""Encoders that take no time, or go wrong on purpose, and small catalogues for them."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from nispcodec.catalogue.batch import Batch
from nispcodec.catalogue.config import BatchConfig
from nispcodec.catalogue.find import find_assets
from nispcodec.catalogue.job import Encoder, Job, Result
from nispcodec.catalogue.plan import Asset, Shard
from nispcodec.catalogue.settings import Settings
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document, Frame
from nispcodec.core.errors import FitError
from nispcodec.core.progress import Listener, Progress
from nispcodec.encode.config import EncodeConfig
from nispcodec.model import NispModel
from tests import tiny

TRIANGLES = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
PLAIN = BatchConfig(jobs=2, thumbnail=0)


def document(mesh: TexturedMesh) -> Document:
    """The same for every mesh but for its place: its center is the mesh's first corner."""
    x, y, z = mesh.positions.min(axis=0).tolist()
    return tiny.document(frame=Frame((x, y, z), 2.0))


def quick(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
    """Takes no time, and warns."""
    listen(Progress(stage="fit", warning=f"{mesh.name}: a warning"))
    return NispModel(document(mesh))


def wild(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
    """Does what the asset's name says."""
    if mesh.name.startswith("dies"):
        os.abort()
    if mesh.name.startswith("hangs"):
        time.sleep(600)
    if mesh.name.startswith("hungry"):
        bytearray(64_000_000_000)
    if mesh.name.startswith("refused"):
        raise FitError(f"{mesh.name}: expected a fit, found none")
    if mesh.name.startswith("buggy"):
        raise KeyError("a bug")
    if mesh.name.startswith("full"):
        raise OSError(28, "No space left on device")
    if mesh.name.startswith("slow"):
        time.sleep(0.3)
    return NispModel(document(mesh))


def once(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
    """Crashes where it has not crashed before: a file beside the tests' folder remembers."""
    mark = Path(os.environ["NISP_TEST_MARKS"]) / mesh.name
    if not mark.exists():
        mark.touch()
        os.abort()
    return NispModel(document(mesh))


def meshes(folder: Path, *names: str) -> Path:
    """A folder with an OBJ for each name, each a little elsewhere."""
    for number, name in enumerate(names):  # a comment makes each file another
        path = folder / f"{name}.obj"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"# {name!a}\n" + TRIANGLES.replace("v 0", f"v 0.{number % 900 + 1}"))
    return folder


def batch(folder: Path, encode: Encoder = quick, config: BatchConfig = PLAIN) -> Batch:
    """A batch into a folder, with a stub for an encoder."""
    return Batch(str(folder), config=config, encode=encode)


def ran(inputs: Sequence[Path | str], run: Batch, shard: Shard | None = None) -> dict[str, Result]:
    """Run it to its end -> results by output, or by source where there is none."""
    run.shard = shard
    found = list(find_assets([str(each) for each in inputs]))
    results = {each.record.output or each.record.source: each for each in run.run(found)}
    return results


def job(source: Path, folder: Path) -> Job:
    """A job for one mesh file."""
    return Job(Asset(str(source), f"{source.stem}.nisp"), str(folder), Settings())


def few_steps(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
    """The real encoder, whose fits are short."""
    import nispcodec
    from tests.encode.tunings import small

    return nispcodec.encode(mesh, config, listen, small(300, 30, 1, 20, 5))


def with_stub(monkeypatch: pytest.MonkeyPatch, encode: Encoder) -> None:
    """Batches that are made without an encoder get this one."""
    usual = Batch.__init__

    def made(self: Batch, *args: Any, **kwargs: Any) -> None:
        usual(self, *args, **{"encode": encode, **kwargs})

    monkeypatch.setattr(Batch, "__init__", made)
