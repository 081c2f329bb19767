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
from nispcodec.dataset.chart_borders import near_other_charts
from nispcodec.dataset.config import SamplingConfig
from nispcodec.geometry.z_order import z_order

BLOCK = 1 << 15


def chart_error_weight(
    mesh: TexturedMesh,
    table: ChartTable,
    samples: SampleSet,
    neighbors: int,
    looks: int = SamplingConfig.chart_looks,
) -> Float64Array:
    """Weights (n,) of samples: how far the colors of neighbors on other charts are off.

    The mean, over the `neighbors` nearest samples and the sample itself among them, of the root
    mean square difference of color and alpha; neighbors on the sample's own chart count as 0.
    By `looks` samples it is told how far the nearest are. Raises MeshError for a texture that does
    not decode.
    """
    weight = np.zeros(len(samples))
    count = min(neighbors, len(samples))
    if len(np.unique(samples.chart)) < 2:
        return weight
    rows, near = _at_borders(samples, count, looks)
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


def _at_borders(samples: SampleSet, count: int, looks: int) -> tuple[Int64Array, Int32Array]:
    """Samples (k,) with another chart among the `count` nearest, and these (k, count).

    Only those are asked that have another chart in cells about them as wide as the nearest are far:
    one in five or ten. They are asked block by block in the order of space, in little memory.
    """
    order = z_order(samples.points.astype(np.float64))
    points, charts = samples.points[order], samples.chart[order]
    tree, ranks = cKDTree(points), list(range(1, count + 1))
    looked_at = points[:: len(points) // looks + 1]
    width = float(tree.query(looked_at, [count])[0].max())
    asked = np.flatnonzero(near_other_charts(points, charts, width))
    rows, nearest = [], []
    for start in range(0, len(asked), BLOCK):
        block = asked[start : start + BLOCK]
        near = tree.query(points[block], ranks, workers=cores())[1].reshape(len(block), count)
        mixed = np.flatnonzero((charts[near] != charts[block, None]).any(axis=1))
        rows.append(order[block[mixed]])
        nearest.append(order[near[mixed]].astype(np.int32))
    empty = np.zeros((0, count), np.int32)
    return np.concatenate([np.zeros(0, np.int64), *rows]), np.concatenate([empty, *nearest])


def _colors(mesh: TexturedMesh, table: ChartTable, samples: SampleSet) -> Float64Array:
    uvs = samples.uv * np.asarray(table.uv_scale) + np.asarray(table.uv_offset)
    owners, has_uv = table.materials[samples.chart], table.has_uv[samples.chart]
    shown = base_colors(mesh.materials, mesh.textures, owners, has_uv, uvs)
    return shown.astype(np.float64)
