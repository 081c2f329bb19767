"""Frames on a surface: the tangent plane, and the directions in which u and v grow."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array


def tangent_axes(normals: Float32Array) -> tuple[Float32Array, Float32Array]:
    """Two arrays of unit vectors (n, 3) that complete unit normals (n, 3) to right-handed frames.

    Duff et al., "Building an Orthonormal Basis, Revisited", 2017.
    """
    x, y, z = normals.T
    sign = np.copysign(np.float32(1), z)
    a = -1 / (sign + z)
    b = x * y * a
    first = np.column_stack([1 + sign * x * x * a, sign * b, -sign * x])
    second = np.column_stack([b, sign + y * y * a, -y])
    return first, second


def tangent_frames(
    normals: Float32Array, jacobians: Float32Array
) -> tuple[Float32Array, Float32Array]:
    """Tangents and bitangents (n, 3), unit, at right angles to unit normals and to each other.

    As glTF has them (and MikkTSpace): the tangent is the direction in which u grows while v stays,
    made perpendicular to the normal; the bitangent is on the side where v grows, so that mirrored
    charts get a left-handed frame. Without a usable Jacobian (n, 2, 3) the frame is any.
    """
    u, v = jacobians[:, 0], jacobians[:, 1]
    side = np.where((np.cross(u, v) * normals).sum(axis=1) < 0, -1, 1).astype(np.float32)
    # Where v stays, one moves at right angles to its gradient and to the normal.
    along = np.cross(v, normals) * side[:, None]
    length = np.linalg.norm(along, axis=1, keepdims=True)
    tangents = np.where(length > 1e-6, along / np.maximum(length, 1e-6), tangent_axes(normals)[0])
    return tangents, np.cross(normals, tangents) * side[:, None]
