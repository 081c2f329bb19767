"""The work of one asset, in a worker: what `nisp encode` does, then verify, measure and record."""

from __future__ import annotations

import time
import traceback
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from nispcodec import __version__
from nispcodec.catalogue import record as kinds
from nispcodec.catalogue.inputs import content, read_noted, sha256, unchanged
from nispcodec.catalogue.job import Encoder, Job, Result
from nispcodec.catalogue.record import DONE, Record
from nispcodec.catalogue.storage import full_disk, joined, storage_of
from nispcodec.catalogue.thumbnails import thumbnails
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import FitError, FormatError, MeshError, NispError
from nispcodec.core.progress import Listener, Progress
from nispcodec.encode.config import EncodeConfig
from nispcodec.model import NispModel


def encoder(mesh: TexturedMesh, config: EncodeConfig, listen: Listener) -> NispModel:
    """The encoder of `nisp encode`. Raises what `nispcodec.encode` raises."""
    from nispcodec import encode

    return encode(mesh, config, listen)


def work(job: Job, encode: Encoder = encoder) -> Result:
    """Encode an asset, unless that is done already; never raises but for Ctrl-C.

    The output is written whole or not at all, and after it was verified.
    """
    try:
        if job.earlier is not None and _still_done(job, job.earlier):
            return Result(job.earlier, kept=True)
        return Result(_made(job, encode))
    except Exception as why:
        return Result(replace(job.failed(_kind(why), _sentence(why)), tries=job.tries))


def _still_done(job: Job, earlier: Record) -> bool:
    """Whether output, settings and all that the asset is read from are as they were recorded."""
    if not earlier.done or earlier.settings != job.settings.digest:
        return False
    place = joined(job.folder, job.asset.output)
    try:
        same = sha256(storage_of(place).read(place)) == earlier.sha256
    except OSError:
        return False
    return same and unchanged(job.asset.source, earlier.inputs)


def _made(job: Job, encode: Encoder) -> Record:
    """Raises NispError, OSError, MemoryError and whatever a bug raises."""
    started, output = time.monotonic(), job.asset.output
    place = joined(job.folder, output)
    storage = storage_of(place)
    read, inputs, sizes = read_noted(job.asset.source)
    mesh = _unwrapped(read) if job.settings.unwrap else read
    model, warnings = _encoded(job, mesh, encode)
    data = _verified(model)
    storage.write(place, data)
    encoded = time.monotonic() - started
    errors = _errors(model, mesh, job.compare)
    for name, picture in thumbnails(model, mesh, job.thumbnail).items():
        storage.write(joined(job.folder, thumbnail_of(output, name)), picture)
    return Record(
        source=job.asset.source,
        output=output,
        status=DONE,
        content=content(inputs),
        inputs=inputs,
        settings=job.settings.digest,
        options=job.settings.options,
        sha256=sha256(data),
        bytes={
            **_rate(data),
            "input_mesh": sizes.mesh,
            "input_textures": sizes.textures,
        },
        errors=errors,
        seconds={"encode": round(encoded, 3), "all": round(time.monotonic() - started, 3)},
        warnings=warnings,
        tries=job.tries,
        nispcodec=__version__,
    )


def _unwrapped(mesh: TexturedMesh) -> TexturedMesh:
    """With an atlas of its own. A crash of the native library ends the worker, and this job."""
    from nispcodec.bake.unwrap import unwrap, with_collapsed_named

    return with_collapsed_named(unwrap(mesh))


def _encoded(job: Job, mesh: TexturedMesh, encode: Encoder) -> tuple[NispModel, tuple[str, ...]]:
    """The model, and all that reader and encoder warn of."""
    warnings = list(mesh.warnings)

    def heard(update: Progress) -> None:
        if update.warning:
            warnings.append(update.warning)

    config = replace(job.settings.encode, threads=job.threads)
    return encode(mesh, config, heard), tuple(warnings)


def thumbnail_of(output: str, name: str) -> str:
    """The path of a picture beside an output."""
    return f"{output.removesuffix('.nisp')}.{name}.webp"


def _verified(model: NispModel) -> bytes:
    """The model's file. Raises FormatError where `nisp verify` would find a fault in it."""
    from nispcodec.core.texture import decode_image
    from nispcodec.format import pack
    from nispcodec.format.verify import verify

    data = pack(model.document)
    for problem in verify(data, decode_image):
        raise problem
    return data


def _rate(data: bytes) -> dict[str, int]:
    from nispcodec.format import own_bytes

    own = own_bytes(data)
    return {"geometry_uv": own, "textures": len(data) - own, "total": len(data)}


def _errors(model: NispModel, mesh: TexturedMesh, compare: bool) -> dict[str, float]:
    """What the encode measured of itself; and of the decoded mesh, if asked for."""
    info = model.document.info
    found = {
        name: float(value)
        for name, value in info.items()
        if isinstance(value, float | int) and ("error" in name or "accuracy" in name)
    }
    return found | (_compared(model, mesh) if compare else {})


def _compared(model: NispModel, mesh: TexturedMesh) -> dict[str, float]:
    from nispcodec import compare

    report: Mapping[str, Mapping[str, object]] = compare(mesh, model)
    picked = {
        "decoded_distance_mean": ("geometry", "mean"),
        "decoded_distance_p99": ("geometry", "p99"),
        "decoded_uv_median": ("uv", "median"),
    }
    found = {}
    for name, (group, value) in picked.items():
        larger = report.get(group, {}).get("larger")
        if isinstance(larger, dict):
            found[name] = float(larger[value])
    psnr = report["color"]["psnr"]
    return found | ({"decoded_color_psnr": psnr} if isinstance(psnr, float) else {})


def _kind(why: Exception) -> str:
    """What kind of failure an error is; the first that fits, as errors of ours may hide others."""
    if isinstance(why, MemoryError):
        return kinds.MEMORY
    if full_disk(why):
        return kinds.DISK
    if isinstance(why, MeshError | FitError | FormatError):
        return kinds.INPUT
    if isinstance(why, OSError) or isinstance(why.__cause__, OSError):
        return kinds.STORAGE
    return kinds.INPUT if isinstance(why, NispError) else kinds.BUG


def _sentence(why: Exception) -> str:
    """The error on one line; one that is none of ours with its type and place."""
    said = " ".join(str(why).split())
    if isinstance(why, NispError):
        return said
    if isinstance(why, MemoryError):
        return "expected enough memory, found too little: --memory allows more"
    place = traceback.extract_tb(why.__traceback__)[-1]
    return f"{type(why).__name__} at {Path(place.filename).name}:{place.lineno}: {said}"
