#!/usr/bin/env bash
# point-cloud-utils: make_mesh_watertight makes a mesh that is watertight already 6 % larger
#
# Versions:   point-cloud-utils 0.34.0, numpy 2.4.6
# Behavior:  the mesh is rebuilt around an octree of `resolution` leaves, a cell or two outside of the input, also where
#             the input is closed and needed nothing. The offset is one-sided, so it does not average out: 2 % of the
#             radius at the default of 20,000.
# Output seen: unit sphere of 1,472 triangles, closed: default: 80,000 faces, volume x 1.06, radius 1.008 to 1.021; 5,000:
#             volume x 1.13, radius 1.025 to 1.042
# One would guess: a repair leaves a sound mesh alone, or moves it by less than a cell either way.
# Who is hurt: training sets of signed distances, for which meshes are commonly made watertight first: every distance is
#             off by 0.008 to 0.02 of the radius, ten times what a network of a few kilobytes errs.
# Instead:    check that the mesh is closed and leave it; else sign by winding number; or move points back to the input.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check point-cloud-utils==0.34.0 numpy==2.4.6
env/bin/python - <<'EOF'
import numpy as np
import point_cloud_utils as pcu

def sphere(rows=24, cols=32):
    theta, phi = np.linspace(0, np.pi, rows + 1)[1:-1], np.arange(cols) * 2 * np.pi / cols
    ring = np.stack([np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi)),
                     np.outer(np.cos(theta), np.ones(cols))], -1).reshape(-1, 3)
    faces = []
    for j in range(cols):
        k = (j + 1) % cols
        faces += [[len(ring), j, k], [len(ring) + 1, (rows - 2) * cols + k, (rows - 2) * cols + j]]
        for i in range(rows - 2):
            a, b, c, d = i * cols + j, (i + 1) * cols + j, (i + 1) * cols + k, i * cols + k
            faces += [[a, b, c], [a, c, d]]
    return np.vstack([ring, [[0, 0, 1], [0, 0, -1]]]), np.array(faces)

def volume(points, faces):
    a, b, c = (points[faces[:, k]] for k in range(3))
    return float((a * np.cross(b, c)).sum() / 6)

points, faces = sphere()
print(f"source: {len(faces)} faces, volume {volume(points, faces):.3f}")
ratio = {}
for resolution in (5000, 20000):
    repaired, tris = pcu.make_mesh_watertight(points, faces, resolution, seed=1)
    radii = np.linalg.norm(repaired, axis=1)
    ratio[resolution] = volume(repaired, tris) / volume(points, faces)
    print(f"resolution {resolution}: {len(tris)} faces, volume x {ratio[resolution]:.3f}, radius {radii.min():.3f} to {radii.max():.3f}")
    assert (np.median(radii) > 1.005), "vertices lie on the input now"
assert ratio[5000] > 1.08 and ratio[20000] > 1.04, "no longer inflated"
print("as described")
EOF
