"""Where a texture has detail: an error in UV is seen there, and nowhere else."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array
from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.document import ChartTable
from nispcodec.core.texture import base_color, decode_image
from nispcodec.dataset.sample_set import SampleSet

NEARBY = 2e-3
"""How far off in UV colors are compared: a few times as far as UV networks err."""

WAYS = NEARBY * np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])


def detail(mesh: TexturedMesh, table: ChartTable, samples: SampleSet) -> Float64Array:
    """(n,) root mean square change of color and alpha `NEARBY`; 0 where there is no texture."""
    uvs = samples.uv * np.asarray(table.uv_scale) + np.asarray(table.uv_offset)
    owners = np.where(table.has_uv, table.materials, -1)[samples.chart]
    found = np.zeros(len(samples))
    for number, material in enumerate(mesh.materials):
        used, owned = material.maps.get("base_color"), owners == number
        if used is not None and owned.any():
            found[owned] = _change(material, decode_image(mesh.textures[used.texture]), uvs[owned])
    return found


def _change(material: Material, image: Float32Array, uvs: Float64Array) -> Float64Array:
    here = base_color(material, image, uvs)
    squares = [((base_color(material, image, uvs + way) - here) ** 2).mean(axis=1) for way in WAYS]
    return np.sqrt(np.mean(squares, axis=0)).astype(np.float64)
