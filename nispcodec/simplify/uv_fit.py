"""UVs moved so that each point of one surface has the UV of the closest point of the other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.simplify.closest import Tree
from nispcodec.simplify.config import FitConfig
from nispcodec.simplify.least_squares import Pull, pulled
from nispcodec.simplify.retreat import without_folds
from nispcodec.simplify.samples import sample_count, spread
from nispcodec.simplify.source import Source
from nispcodec.simplify.triangles import Triangles


def fitted_uvs(
    source: Source, triangles: Triangles, config: FitConfig = FitConfig(), seed: int = 0
) -> Triangles:
    """The same triangles with other UVs: least squares, reweighed towards the mean of misses.

    No UV triangle turns over. Where no triangle has an area left, as on coarse grids, UVs stay.
    """
    if Tree(triangles.corners).is_flat:
        return triangles
    pairs = _pairs(source, triangles, config, np.random.default_rng([seed, 1]))
    if not len(pairs.weights):
        return triangles
    softness = config.softness * float(np.median(_misses(pairs, triangles.uvs)))
    uvs = triangles.uvs
    for _ in range(config.uv_rounds):
        weights = 1 / np.maximum(_misses(pairs, uvs), softness + np.finfo(np.float64).eps)
        uvs = pulled(uvs, [replace(pairs, weights=weights)], config.uv_damping, config.solver)
    faces = triangles.uv_faces[triangles.has_uv]
    unfolded = without_folds(faces, triangles.uvs, uvs, config.halvings)
    return replace(triangles, uvs=unfolded)


def _pairs(
    source: Source, triangles: Triangles, config: FitConfig, rng: np.random.Generator
) -> Pull:
    """Points of both surfaces with the source's UV there, where both are of the same patch."""
    tree, count = Tree(triangles.corners), sample_count(len(triangles.uvs), config)
    there, own = spread(source.tree, count, rng), spread(tree, count, rng)
    near, back = tree.closest(there.positions), source.tree.closest(own.positions)
    faces = np.concatenate([near.faces, own.faces])
    origins = np.concatenate([there.faces, back.faces])
    means = np.concatenate([near.weights, own.weights])
    uvs = source.triangles.corner_uvs
    targets = np.concatenate([there.interpolate(uvs), back.interpolate(uvs)])
    facing = (tree.normals[faces] * source.tree.normals[origins]).sum(axis=1) > 0
    same = triangles.patches[faces] == source.triangles.patches[origins]
    chosen = same & facing & triangles.has_uv[faces]
    vertices = triangles.uv_faces[faces[chosen]]
    return Pull(vertices, means[chosen], targets[chosen], np.ones(int(chosen.sum())))


def _misses(pairs: Pull, uvs: Float64Array) -> Float64Array:
    """(s,): how far points are from their targets."""
    points = (pairs.means[:, :, None] * uvs[pairs.vertices]).sum(axis=1)
    misses: Float64Array = np.linalg.norm(points - pairs.targets, axis=1)
    return misses
