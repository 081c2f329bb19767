"""How much a texture changes around samples: an error in UV is seen there, and nowhere else."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, Uint8Array
from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.document import ChartTable
from nispcodec.core.sample_set import SampleSet
from nispcodec.core.texture import base_color, stored_pixels

DIRECTIONS = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])


def texture_gradient(
    mesh: TexturedMesh, table: ChartTable, samples: SampleSet, step: float
) -> Float64Array:
    """Texture gradients (n,) of samples: root mean square change of base color and alpha.

    The change is over `step` of the asset's UV to four sides; it is 0 without a texture. Raises
    MeshError for a texture that does not decode.
    """
    uvs = samples.uv * np.asarray(table.uv_scale) + np.asarray(table.uv_offset)
    owners = np.where(table.has_uv, table.materials, -1)[samples.chart]
    found = np.zeros(len(samples))
    for number, material in enumerate(mesh.materials):
        used, owned = material.maps.get("base_color"), owners == number
        if used is not None and owned.any():
            image = stored_pixels(mesh.textures[used.texture])
            found[owned] = _change(material, image, uvs[owned], step)
    return found


def _change(
    material: Material, image: Float32Array | Uint8Array, uvs: Float64Array, step: float
) -> Float64Array:
    here = base_color(material, image, uvs)
    total = np.zeros(len(uvs), dtype=np.float32)
    for way in DIRECTIONS:
        change = base_color(material, image, uvs + step * way) - here
        total += np.einsum("nc,nc->n", change, change)
    return np.sqrt(total / (here.shape[1] * len(DIRECTIONS))).astype(np.float64)
