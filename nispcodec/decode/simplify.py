"""Fewer triangles by quadric edge collapse (Garland and Heckbert, 1997).

The bare surface is simplified, before charts and UVs are looked up: seams are then cut into the
simplified triangles exactly as into the extracted ones, and every UV is still the network's own.
"""

from __future__ import annotations

import numpy as np

from nispcodec.decode.extract import Surface

# How eagerly long edges collapse, 0 to 10: above 5 thin parts fold over, below 5 counts are missed.
AGGRESSIVENESS = 5
ROUGHNESS = 1e-3


def simplified(surface: Surface, faces: int) -> Surface:
    """The surface with about `faces` triangles, or as it is when it has no more than that.

    Its vertices lie where they serve the triangles best, no longer on the zero set.
    """
    if len(surface.faces) <= faces:
        return surface
    from fast_simplification import simplify  # type: ignore[import-untyped]

    # On exactly flat parts all quadrics are 0 and collapses get stuck: make them a little rough.
    noise = np.random.default_rng(0).normal(0, ROUGHNESS * surface.cell, surface.positions.shape)
    rough = surface.positions + noise.astype(np.float32)
    positions, corners = simplify(rough, surface.faces, target_count=faces, agg=AGGRESSIVENESS)
    return Surface(positions.astype(np.float32), corners.astype(np.int32), surface.cell)
