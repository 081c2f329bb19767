#!/usr/bin/env bash
# scikit-image marching_cubes: normals ignore `spacing` and point against the faces; trimesh writes them into files
#
# Versions:   scikit-image 0.26.0, trimesh 5.2.0, numpy 2.4.6
# Behavior:  vertices are multiplied by `spacing`; normals stay as on the grid of cubes, so with slices three times as far
#             apart as pixels they are off by 22 degrees in the mean. They point down the volume's slope
#             whatever gradient_direction says, which turns the faces alone (by a left hand, say the docs): with the default
#             faces and normals disagree, with "ascent" they agree. trimesh's voxel meshes (VoxelGrid.marching_cubes, matrix_to_marching_cubes) keep the normals beside
#             the faces that they contradict, and export both.
# Output seen: signed distance of a unit sphere, spacing .05 .05 .15: volume +4.17, normals 22.3 degrees off the radius in the
#             mean, 33.7 at most, all pointing inwards; even spacing .1: 1.0 and 2.5, inwards; trimesh's GLB of a ball of
#             voxels: faces outwards, NORMAL inwards
# One would guess: four arrays of one call agree; whoever scales vertices scales normals by the inverse.
# Who is hurt: CT and MRI volumes, whose slices are seldom as near as their pixels; point clouds with normals from a field, for
#             Poisson or a network; voxel meshes shaded as if lit from the other side.
# Instead:    drop the normals and compute them from faces; or n = -n / spacing, normalized again. trimesh: before export
#             trimesh.Trimesh(mesh.vertices, mesh.faces).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check scikit-image==0.26.0 trimesh==5.2.0 numpy==2.4.6 scipy==1.17.1
env/bin/python - <<'EOF'
import json

import numpy as np
import trimesh
from skimage.measure import marching_cubes

def volume(points, faces):
    a, b, c = (points[faces[:, k]] for k in range(3))
    return float((a * np.cross(b, c)).sum() / 6)

def sphere(spacing, direction="descent"):
    """Signed volume, angles between normals and the radius in degrees, and the share of normals that point outwards."""
    spacing = np.array(spacing)
    grid = np.stack(np.meshgrid(*(np.arange(n) for n in np.ceil(2.6 / spacing)), indexing="ij"), -1) * spacing - 1.25
    distance = np.linalg.norm(grid, axis=-1) - 1
    points, faces, normals, _ = marching_cubes(distance, 0, spacing=tuple(spacing), gradient_direction=direction)
    points = points - 1.25
    cosines = (normals * points).sum(1) / np.linalg.norm(points, axis=1)
    angles, outwards = np.degrees(np.arccos(np.minimum(np.abs(cosines), 1))), (cosines > 0).mean()
    mended = -normals / spacing
    mended /= np.linalg.norm(mended, axis=1, keepdims=True)
    assert ((mended * points).sum(1) > 0.99).all()  # the advice holds
    print(f"spacing {spacing.tolist()}, {direction}: volume {volume(points, faces):+.2f}, normals off by {angles.mean():.1f} "
          f"degrees, at most {angles.max():.1f}; outwards {outwards:.0%}")
    return volume(points, faces), angles, outwards

inside_out = "faces and normals agree now"
size, angles, outwards = sphere((0.1, 0.1, 0.1))
assert angles.max() < 4 and size > 4 and outwards == 0, inside_out
size, _, outwards = sphere((0.1, 0.1, 0.1), "ascent")
assert size < -4 and outwards == 0, inside_out
size, angles, outwards = sphere((0.05, 0.05, 0.15))
assert size > 4 and outwards == 0, inside_out
assert angles.mean() > 15 and angles.max() > 25, "normals know the spacing now"

grid = np.stack(np.meshgrid(*[np.arange(24)] * 3, indexing="ij"), -1) - 11.5
trimesh.voxel.VoxelGrid(np.linalg.norm(grid, axis=-1) < 8).marching_cubes.export("ball.glb")
with open("ball.glb", "rb") as file:
    data = file.read()
head = int.from_bytes(data[12:16], "little")
document, body = json.loads(data[20:20 + head]), data[28 + head:]
attributes = document["meshes"][0]["primitives"][0]["attributes"]

def read(index):
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return np.frombuffer(body, np.float32, 3 * accessor["count"], start).reshape(-1, 3)

points, normals = read(attributes["POSITION"]), read(attributes["NORMAL"])
mesh = trimesh.load("ball.glb").to_mesh()
outwards = ((points - points.mean(0)) * normals).sum(1) > 0
print(f"trimesh GLB: volume {mesh.volume:+.0f}, NORMAL outwards {outwards.mean():.0%}")
assert mesh.volume > 2000 and not outwards.any(), inside_out
print("as described")
EOF
