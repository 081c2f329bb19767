#!/usr/bin/env bash
# xatlas: a model in metres with fine triangles gets NaN for all its UVs, a small part of a larger one gets (0, 0)
#
# Versions:   xatlas 0.0.11 (Python), numpy 2.4.6
# Behavior:  triangles of less than about 1.2e-7 square units (the smallest step of a float at 1) count as degenerate,
#             whatever the size of the mesh, and are left out of charts. If all are, the atlas is empty and its UVs are
#             0 / 0; if some are, those are put on the point (0, 0). parametrize() returns as usual.
# Output seen: a ball of 1,984 triangles: radius 50 mm fine; 2 mm, in metres: every UV NaN; a 2 mm ball beside one of
#             1 m: all the small one's triangles have no area in UV; the same in millimetres: fine
# One would guess: an unwrap does not depend on the unit; what cannot be unwrapped is an error.
# Who is hurt: jewellery, electronics, screws and scans in metres, as glTF demands; NaN in a texture bake.
# Instead:    scale so that the mean triangle is about 1 before xatlas (UVs do not change), and check every face that
#             has an area for UVs that have one. trimesh's unwrap() hands the mesh on as it is.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check xatlas==0.0.11 numpy==2.4.6
env/bin/python - <<'EOF'
import numpy as np
import xatlas

def ball(radius, rows=32, cols=32):
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
    return np.vstack([ring, [[0, 0, 1], [0, 0, -1]]]) * radius, np.array(faces)

def unwrap(name, vertices, faces):
    """UV area of each triangle, NaN where the UVs are."""
    _, index, uv = xatlas.parametrize(vertices.astype(np.float32), faces.astype(np.uint32))
    a, b, c = (uv[index[:, k]].astype(float) for k in range(3))
    area = np.abs((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])) / 2
    print(f"{name}: NaN {np.isnan(area).mean():.0%}, no area in UV {(area == 0).mean():.0%} of {len(area)} triangles")
    return area

area = unwrap("ball of 50 mm in metres", *ball(0.05))
assert (area > 0).all()
area = unwrap("ball of 2 mm in metres", *ball(0.002))
assert np.isnan(area).all(), "small triangles are unwrapped now"
area = unwrap("ball of 2 mm in millimetres", *ball(2.0))
assert (area > 0).all()
(small, faces), (large, _) = ball(0.002), ball(1.0)
area = unwrap("2 mm beside 1 m", np.vstack([large, small + [2, 0, 0]]), np.vstack([faces, faces + len(large)]))
assert (area[:len(faces)] > 0).all() and (area[len(faces):] == 0).all(), "small parts are unwrapped now"
print("as described")
EOF
