#!/usr/bin/env bash
# fast-simplification: a flat sheet shrinks; a square cut to 20 triangles has lost a fifth of its area
#
# Versions:   fast-simplification 0.2.0; beside it meshoptimizer 0.2.30a0 (Python), numpy 2.4.6
# Behavior:  open borders have no weight of their own: on a plane every collapse costs nothing, so corners and edges of
#             the sheet are pulled in. There is no option to hold borders. Closed meshes are fine. meshoptimizer at the
#             same count keeps the square.
# Output seen: unit square of 3,042 triangles: to 1,000: area 0.997; 100: 0.987; 20: 0.806; 4: 0.386; meshoptimizer: 1.000
# One would guess: a plane is the easy case; two triangles hold it exactly.
# Who is hurt: decals, leaves, hair cards, cloth, terrain tiles (gaps between tiles), every mesh cut along UV seams: a
#             textured mesh with vertices split at seams is open along each, and its charts come apart.
# Instead:    meshoptimizer's simplify (optionally SIMPLIFY_LOCK_BORDER); or compare border lengths before and after.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check fast-simplification==0.2.0 meshoptimizer==0.2.30a0 numpy==2.4.6
env/bin/python - <<'EOF'
import fast_simplification
import meshoptimizer
import numpy as np

n = 40
x, y = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n)))
points = np.c_[x, y, 0 * x].astype(np.float32)
i = np.arange(n * n).reshape(n, n)
a, b, c, d = i[:-1, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel(), i[1:, :-1].ravel()
faces = np.vstack([np.c_[a, b, c], np.c_[a, c, d]]).astype(np.int32)

def area(vertices, tris):
    p, q, r = (np.asarray(vertices, float)[tris[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(q - p, r - p), axis=1).sum() / 2)

lost = {}
for target in (1000, 100, 20, 4):
    vertices, tris = fast_simplification.simplify(points, faces, target_count=target)
    out = np.zeros(faces.size, np.uint32)
    count = meshoptimizer.simplify(out, faces.ravel().astype(np.uint32), points, target_index_count=3 * target)
    other = out[:count].reshape(-1, 3)
    lost[target] = 1 - area(vertices, tris)
    print(f"{len(faces)} -> {target}: fast-simplification {len(tris)} triangles, area {area(vertices, tris):.3f}; "
          f"meshoptimizer {len(other)}, area {area(points, other):.3f}")
    assert abs(area(points, other) - 1) < 1e-5
assert lost[20] > 0.1 and lost[4] > 0.3, "borders are kept now"
print("as described")
EOF
