#!/usr/bin/env bash
# libigl: rays go through triangles whose sides are below a thousandth: a closed sphere of 3 cm, in meters, is open
#
# Versions:   libigl 2.6.3 (Python), embreex 4.4.0.post1, numpy 2.4.6
# Behavior:  the ray queries (AABB.intersect_ray, AABB.intersect_ray_first, ray_mesh_intersect) compare the determinant
#             of a triangle's two edges and the ray's direction with a fixed 1e-6, and take a ray with a smaller one for
#             parallel. It grows with the square of the edges: a right triangle with sides of 0.0008 is never met by a
#             ray of unit length. A longer direction of the same ray makes it larger, and the triangle is met.
# Output seen: 1000 rays from the center of a sphere of 40,000 triangles: at radius 1, 0.1, 0.03 libigl lets 0.000, 0.003,
#             1.000 of them out; with directions 1e4 long none; Embree none.
# One would guess: a closed mesh is closed whatever its unit, and the length of a direction changes only the distance.
# Who is hurt: whoever tells inside from outside, tells what can be seen, or bakes occlusion: millimeters in a scene in
#             meters, dense scans in a unit box. Nothing is raised.
# Instead:    embreex, or directions so long that determinants are far above 1e-6.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check libigl==2.6.3 embreex==4.4.0.post1 numpy==2.4.6
env/bin/python - <<'EOF'
import igl
import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

# A closed sphere by latitude and longitude.
rows, cols = 100, 200
theta, phi = np.linspace(0, np.pi, rows + 1), np.arange(cols) * 2 * np.pi / cols
sphere = np.stack([np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi)),
                   np.outer(np.cos(theta), np.ones(cols))], -1).reshape(-1, 3)
i, j = np.meshgrid(np.arange(rows), np.arange(cols), indexing="ij")
k = (j + 1) % cols
corners = [i * cols + j, (i + 1) * cols + j, (i + 1) * cols + k, i * cols + k]
faces = np.concatenate([np.stack([corners[a] for a in each], -1).reshape(-1, 3) for each in ((0, 1, 2), (0, 2, 3))])

ways = np.random.default_rng(0).normal(size=(1000, 3))
ways /= np.linalg.norm(ways, axis=1, keepdims=True)
start = np.zeros((1000, 3))

def out_of(radius, length):
    """The share of rays that libigl lets out of the sphere, and Embree."""
    positions = radius * sphere
    tree = igl.AABB()
    tree.init(positions, faces)
    hit = tree.intersect_ray_first(positions, faces, start, length * ways)[0]
    scene = EmbreeScene()
    TriangleMesh(scene, positions[faces].astype(np.float32))
    met = scene.run(start.astype(np.float32), (length * ways).astype(np.float32))
    return (np.asarray(hit).reshape(-1) < 0).mean(), (met < 0).mean()

found = {(radius, length): out_of(radius, length) for radius in (1.0, 0.1, 0.03) for length in (1.0, 1e4)}
for (radius, length), (by_libigl, by_embree) in found.items():
    print(f"radius {radius}, directions {length:g} long: libigl lets {by_libigl:.3f} out, Embree {by_embree:.3f}")

assert found[1.0, 1.0][0] == 0
assert 0 < found[0.1, 1.0][0] < 0.05, "libigl meets what it missed"
assert found[0.03, 1.0][0] > 0.99, "libigl meets small triangles now"
assert all(found[radius, 1e4][0] == 0 for radius in (1.0, 0.1, 0.03)), "the length no longer helps"
assert all(by_embree == 0 for _, by_embree in found.values())
print("as described")
EOF
