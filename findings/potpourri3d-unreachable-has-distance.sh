#!/usr/bin/env bash
# potpourri3d: a body that cannot be reached gets an ordinary geodesic distance, not infinity
#
# Versions:   potpourri3d 1.4.0, numpy 2.4.6, scipy 1.17.1
# Behavior:  the heat method solvers for meshes and for point clouds answer for every vertex. On a part that no edge joins
#             to the source the result is one constant, here half of the farthest reachable distance, and so nearer than
#             half of the body that the source is on. No warning, no NaN.
# Output seen: two unit spheres, centres 5 apart, source on one. Mesh: own sphere 0 to 3.133, the other 1.567 at every
#             vertex; point cloud: 0 to 3.050, the other 1.525; graph search along edges: the other inf
# One would guess: infinity, NaN or at least something larger than all that can be reached (graph search says infinity).
# Who is hurt: charts, parts and seams split by geodesic distance: assets are many bodies, and UV seams with split
#             vertices cut a body into pieces that cannot be reached.
# Instead:    label connected components first and set the others to infinity yourself; weld seams before.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check potpourri3d==1.4.0 numpy==2.4.6 scipy==1.17.1
env/bin/python - <<'EOF'
import numpy as np
import potpourri3d
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

def sphere(rows=24, cols=36):
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

one, tris = sphere()
points, faces = np.vstack([one, one + [5, 0, 0]]), np.vstack([tris, tris + len(one)])
source = len(one) - 1  # a pole
heat = potpourri3d.MeshHeatMethodDistanceSolver(points, faces).compute_distance(source)
cloud = potpourri3d.PointCloudHeatSolver(points).compute_distance(source)
edges = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
keep = np.unique(np.sort(edges, axis=1), axis=0, return_index=True)[1]
graph = coo_array((lengths[keep], (edges[keep, 0], edges[keep, 1])), shape=(len(points),) * 2)
search = dijkstra(graph, directed=False, indices=source)
for name, d in (("mesh solver", heat), ("point cloud solver", cloud), ("graph search", search)):
    print(f"{name}: own sphere {d[:len(one)].min():.3f} to {d[:len(one)].max():.3f}, "
          f"the other {d[len(one):].min():.3f} to {d[len(one):].max():.3f}")
for d in (heat, cloud):
    assert np.isfinite(d).all(), "unreachable vertices are marked now"
    assert d[len(one):].max() < 0.75 * d[:len(one)].max(), "unreachable vertices are far now"
assert np.isinf(search[len(one):]).all()
print("as described")
EOF
