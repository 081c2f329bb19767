"""How visible a wrong chart is: how far colors of other charts beside a sample are from its own."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from nispcodec.core.arrays import Float64Array, Int32Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.cores import cores
from nispcodec.core.document import ChartTable
from nispcodec.core.sample_set import SampleSet
from nispcodec.core.texture import base_colors
from nispcodec.geometry.z_order import z_order

BLOCK = 1 << 15


def chart_error_weight(
    mesh: TexturedMesh, table: ChartTable, samples: SampleSet, neighbors: int
) -> Float64Array:
    """Weights (n,) of samples: how far the colors of neighbors on other charts are off.

    The mean, over the `neighbors` nearest samples and the sample itself among them, of the root
    mean square difference of color and alpha; neighbors on the sample's own chart count as 0.
    Raises MeshError for a texture that does not decode.
    """
    weight = np.zeros(len(samples))
    count = min(neighbors, len(samples))
    if len(np.unique(samples.chart)) < 2:
        return weight
    rows, near = _at_borders(samples, count)
    seen = np.zeros(len(samples), dtype=bool)
    seen[rows] = seen[near] = True
    colors, place = _colors(mesh, table, samples[seen]), np.cumsum(seen) - 1
    own = colors[place[rows]]
    total = np.zeros(len(rows))
    for other in near.T:
        apart = colors[place[other]] - own
        off = np.sqrt(np.einsum("nc,nc->n", apart, apart) / apart.shape[1])
        total += off * (samples.chart[other] != samples.chart[rows])
    weight[rows] = total / count
    return weight


def _at_borders(samples: SampleSet, count: int) -> tuple[Int64Array, Int32Array]:
    """Samples (k,) with another chart among the `count` nearest, and these (k, count).

    Asked block by block in the order of space: thrice as fast, in little memory.
    """
    order = z_order(samples.points.astype(np.float64))
    points, charts = samples.points[order], samples.chart[order]
    tree = cKDTree(points)
    rows, nearest = [], []
    for start in range(0, len(points), BLOCK):
        block = slice(start, start + BLOCK)
        near = tree.query(points[block], list(range(1, count + 1)), workers=cores())[1]
        mixed = np.flatnonzero((charts[near] != charts[block, None]).any(axis=1))
        rows.append(order[start + mixed])
        nearest.append(order[near[mixed]].astype(np.int32))
    return np.concatenate(rows), np.concatenate(nearest)


def _colors(mesh: TexturedMesh, table: ChartTable, samples: SampleSet) -> Float64Array:
    uvs = samples.uv * np.asarray(table.uv_scale) + np.asarray(table.uv_offset)
    owners, has_uv = table.materials[samples.chart], table.has_uv[samples.chart]
    shown = base_colors(mesh.materials, mesh.textures, owners, has_uv, uvs)
    return shown.astype(np.float64)
