"""How visible a wrong chart is: how far colors of other charts beside a sample are from its own."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import ChartTable
from nispcodec.core.sample_set import SampleSet
from nispcodec.core.texture import base_colors


def chart_error_weight(
    mesh: TexturedMesh, table: ChartTable, samples: SampleSet, neighbors: int
) -> Float64Array:
    """Weights (n,) of samples: how far the colors of neighbors on other charts are off.

    The mean, over the `neighbors` nearest samples and the sample itself among them, of the root
    mean square difference of color and alpha; neighbors on the sample's own chart count as 0.
    Raises MeshError for a texture that does not decode.
    """
    uvs = samples.uv * np.asarray(table.uv_scale) + np.asarray(table.uv_offset)
    owners, has_uv = table.materials[samples.chart], table.has_uv[samples.chart]
    shown = base_colors(mesh.materials, mesh.textures, owners, has_uv, uvs)
    colors = shown.astype(np.float64)
    count = min(neighbors, len(samples))
    near = KDTree(samples.points).query(samples.points, list(range(1, count + 1)), workers=-1)[1]
    total = np.zeros(len(samples))
    for other in near.T:
        off = np.sqrt(((colors[other] - colors) ** 2).mean(axis=1))
        total += off * (samples.chart[other] != samples.chart)
    return total / count
