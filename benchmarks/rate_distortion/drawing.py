"""Pictures of decodes from fixed views: how near they are to the original's, and one to look at."""

from __future__ import annotations

import io
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import PIL.Image

from benchmarks.assets.source import Source
from benchmarks.codecs import codec
from benchmarks.measuring.isolated import WorkFailed, isolated
from benchmarks.measuring.result_file import Record
from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.metrics.pictures import compare_pictures
from nispcodec.render.camera import turntable
from nispcodec.render.views import on_white, render_views

VIEWS, SIZE = 4, 384
QUALITY = 80


@dataclass(frozen=True)
class Gallery:
    """The pictures of one original; decodes are drawn in its frame by the same renderer."""

    source: Source

    @cached_property
    def original(self) -> list[Float32Array]:
        """VIEWS pictures (SIZE, SIZE, 3)."""
        answer, _ = isolated(lambda: self._views(self.source.mesh))
        pictures: list[Float32Array] = answer
        return pictures

    def drawn(self, record: Record, data: bytes) -> tuple[Record, bytes]:
        """The record with mean PSNR and SSIM over the views, and the first picture as WebP."""
        decode = codec(record["codec"]).decode
        try:
            pictures, _ = isolated(lambda: self._views(decode(data, self.source)))
        except WorkFailed as why:
            return record | {"pictures": {"failure": str(why)}}, b""
        pairs = zip(self.original, pictures, strict=True)
        found = [compare_pictures(first, second) for first, second in pairs]
        means = {name: float(np.mean([each[name] for each in found])) for name in found[0]}
        return record | {"pictures": means}, as_webp(pictures[0])

    def _views(self, mesh: TexturedMesh) -> list[Float32Array]:
        frame = self.source.reference.frame
        return [on_white(p) for p in render_views(mesh, turntable(VIEWS), SIZE, frame)]


def as_webp(picture: Float32Array) -> bytes:
    """(h, w, 3) in [0, 1] as the bytes of an image file."""
    pixels = (np.clip(picture, 0, 1) * np.float32(255) + np.float32(0.5)).astype(np.uint8)
    file = io.BytesIO()
    PIL.Image.fromarray(pixels).save(file, "WEBP", quality=QUALITY)
    return file.getvalue()
