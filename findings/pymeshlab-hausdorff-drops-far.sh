#!/usr/bin/env bash
# pymeshlab: the Hausdorff distance leaves out what is far: a part 5 units off counts as 0
#
# Versions:   pymeshlab 2025.7.post1, numpy 2.4.6
# Behavior:  get_hausdorff_distance has maxdist = 50 % of the diagonal by default and drops samples with nothing within
#             it, from the maximum too; only n_samples tells, and nobody knows what it should be. If all are dropped:
#             mean and RMS NaN, max 0. Beside that it samples vertices alone unless sampleface=True, so a large flat
#             face against a bump gives 0 as well.
# Output seen: square + a stray copy 5 above it, against the square: max 0.0, mean 0.0, n_samples 522 of 1,000 asked;
#             with maxdist of 1,000 units: max 5.0. A flat square against one with a bump of 0.5: max 0.0, with sampleface 0.35
# One would guess: a Hausdorff distance is the largest distance; that is the point of it.
# Who is hurt: whoever reports the error of a compressed or decoded mesh: flying specks, the worst fault there is, score 0.
# Instead:    maxdist=PureValue(1e9), sampleface=True, many samples, both directions; and look at n_samples.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check pymeshlab==2025.7.post1 numpy==2.4.6
env/bin/python - <<'EOF'
import numpy as np
import pymeshlab

square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
faces = np.array([[0, 1, 2], [0, 2, 3]])
stray = np.vstack([square, square + [0, 0, 5]])
stray_faces = np.vstack([faces, faces + 4])
bump = np.vstack([square, [[0.5, 0.5, 0.5]]])
bump_faces = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])

def hausdorff(name, first, second, **options):
    meshes = pymeshlab.MeshSet()
    for vertices, tris in (first, second):
        meshes.add_mesh(pymeshlab.Mesh(vertices, tris))
    found = meshes.get_hausdorff_distance(sampledmesh=0, targetmesh=1, **options)
    print(f"{name}: max {found['max']:.3f}, mean {found['mean']:.3f}, n_samples {found['n_samples']}")
    return found

wide = pymeshlab.PureValue(1000)
near = hausdorff("stray part, default maxdist", (stray, stray_faces), (square, faces), sampleface=True, samplenum=1000)
far = hausdorff("stray part, maxdist 1000 units", (stray, stray_faces), (square, faces), sampleface=True, samplenum=1000,
                maxdist=wide)
flat = hausdorff("flat against bump, default", (square, faces), (bump, bump_faces))
full = hausdorff("flat against bump, sampleface", (square, faces), (bump, bump_faces), sampleface=True, samplenum=10000)
assert near["max"] < 1e-6 and near["n_samples"] < 700, "far samples count now"
assert abs(far["max"] - 5) < 1e-5
assert flat["max"] < 1e-6 and full["max"] > 0.3, "faces are sampled by default now"
print("as described")
EOF
