#!/usr/bin/env bash
# trimesh: distances to triangles with sides below half a thousandth go to their edges: ten times too far close to a surface
#
# Versions:   trimesh 5.2.0, rtree 1.4.1, numpy 2.4.6
# Behavior:  triangles.closest_point, under proximity.closest_point and signed_distance, compares products of four lengths
#             with a fixed 1e-13. Where a triangle's sides are below about 5e-4 such a product is always smaller, and a point
#             over its inside is led to an edge. Distances are exact again once the mesh is scaled up.
# Output seen: a cube, 1000 points in and around it, largest error of closest_point in shares of its side, and points whose
#             signed distance is off by more than .01: sides of 1 and .1: 0, 0; .01: .0005, 0; .001: .089, 140; .0001: .337,
#             553. Points 1e-5 above a flat square: with triangles of .003 up to 1.06e-5 away, of .0003 up to 1.07e-4, 4.4e-5
#             in the mean
# One would guess: a distance scales with the mesh.
# Who is hurt: whoever samples signed distances or measures fidelity of parts in millimeters with meters for units, or of
#             dense scans in a unit box: errors look like noise of the surface.
# Instead:    scale vertices and points so that triangles have sides of .1 and more, and divide; or Open3D's RaycastingScene
#             or VTK's vtkImplicitPolyDataDistance, right at every size tried here.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check trimesh==5.2.0 rtree==1.4.1 scipy==1.17.1 numpy==2.4.6
env/bin/python - <<'EOF'
import numpy as np
import trimesh

rng = np.random.default_rng(0)
cube = trimesh.creation.box()
points = rng.uniform(-0.8, 0.8, (1000, 3))
beyond = np.abs(points) - 0.5
exact = np.where((beyond < 0).all(1), beyond.max(1), np.linalg.norm(np.maximum(beyond, 0), axis=1))
errors, off = {}, {}
for side in (1, 0.1, 0.01, 0.001, 0.0001):
    mesh = trimesh.Trimesh(side * cube.vertices, cube.faces, process=False)
    distance = trimesh.proximity.closest_point(mesh, side * points)[1] / side
    errors[side] = float(np.abs(distance - np.abs(exact)).max())
    signed = -trimesh.proximity.signed_distance(mesh, side * points) / side
    off[side] = int((np.abs(signed - exact) > 0.01).sum())
    print(f"cube of {side}: largest error {errors[side]:.4f} of a side, signed {off[side]} of 1000 off by more than .01")

def above(step, cells=40, height=1e-5):
    """Distances to a flat square of cells of step by step, of points at one height above it."""
    i, j = np.meshgrid(np.arange(cells), np.arange(cells), indexing="ij")
    corners = [(i + a) * (cells + 1) + j + b for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    faces = np.concatenate([np.stack([corners[k] for k in each], -1).reshape(-1, 3) for each in ((0, 1, 2), (0, 2, 3))])
    x, y = np.meshgrid(np.arange(cells + 1), np.arange(cells + 1), indexing="ij")
    vertices = step * np.stack([x, y, np.zeros_like(x)], -1).reshape(-1, 3)
    where = np.concatenate([rng.uniform(0, cells * step, (2000, 2)), np.full((2000, 1), height)], 1)
    return trimesh.proximity.closest_point(trimesh.Trimesh(vertices, faces, process=False), where)[1]

coarse, fine = above(0.003), above(0.0003)
for name, distance in (("3e-3", coarse), ("3e-4", fine)):
    print(f"1e-5 above triangles with sides of {name}: {distance.min():.2e} .. {distance.max():.2e}, mean {distance.mean():.2e}")

assert errors[1] < 1e-9 and errors[0.1] < 1e-4
assert off[1] == 0 and off[0.0001] > 300, "signed distances are right now"
assert errors[0.001] > 0.05 and errors[0.0001] > 0.3, "small triangles are met right now"
assert coarse.max() < 1.2e-5
assert fine.max() > 1e-4 and fine.mean() > 3e-5, "small triangles are met right now"
print("as described")
EOF
