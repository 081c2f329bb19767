"""Let balls fall onto an asset from all sides, with NVIDIA Warp: signed distances as a volume.

    pip install warp-lang                               # processors will do, no GPU is needed
    nisp decode model.nisp --grid 128 -o field.npz
    python docs/physics/balls.py field.npz rest.npy     # where 200 balls come to rest (200, 3)

They are drawn to the middle of the grid, and are as thick as six of its spacings.
"""

from __future__ import annotations

import sys

import numpy as np
import warp as wp

BALLS, STEPS, FRICTION = 200, 2000, 0.98


@wp.kernel
def step(
    field: wp.uint64,
    positions: wp.array(dtype=wp.vec3),
    velocities: wp.array(dtype=wp.vec3),
    middle: wp.vec3,
    radius: float,
    seconds: float,
    friction: float,
):
    """Fall for a while, then be pushed out of what the ball has sunk into."""
    ball = wp.tid()
    down = wp.normalize(middle - positions[ball])
    velocity = friction * (velocities[ball] + seconds * down)
    position = positions[ball] + seconds * velocity
    slope = wp.vec3()
    at = wp.volume_world_to_index(field, position)
    distance = wp.volume_sample_grad_f(field, at, wp.Volume.LINEAR, slope)
    if distance < radius:
        out = wp.normalize(slope)
        position += (radius - distance) * out
        velocity -= wp.min(0.0, wp.dot(velocity, out)) * out
    positions[ball] = position
    velocities[ball] = velocity


def main(source: str, output: str) -> None:
    """Read a grid of `nisp decode --grid`, write where balls come to rest (n, 3)."""
    with np.load(source) as grid:
        sdf, origin, spacing = grid["sdf"], grid["origin"], float(grid["spacing"])
    # What is not in the grid is far away.
    volume = wp.Volume.load_from_numpy(
        sdf, min_world=tuple(origin), voxel_size=spacing, bg_value=float(sdf.max()), device="cpu"
    )
    half = spacing * (np.array(sdf.shape) - 1) / 2
    middle, reach = origin + half, float(np.linalg.norm(half))
    ways = np.random.default_rng(0).normal(size=(BALLS, 3))
    start = middle + reach * ways / np.linalg.norm(ways, axis=1, keepdims=True)
    positions = wp.array(start, dtype=wp.vec3, device="cpu")
    velocities = wp.zeros(BALLS, dtype=wp.vec3, device="cpu")
    # Gravity is 1 unit a second^2: something falls to the middle in about sqrt(reach) seconds.
    known = [wp.vec3(*middle), 3 * spacing, 0.01 * reach**0.5, FRICTION]
    for _ in range(STEPS):
        wp.launch(step, BALLS, [volume.id, positions, velocities, *known], device="cpu")
    np.save(output, positions.numpy())


if __name__ == "__main__":
    main(*sys.argv[1:])
