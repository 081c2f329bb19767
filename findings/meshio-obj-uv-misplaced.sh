#!/usr/bin/env bash
# meshio gives the UVs of an OBJ to the wrong vertices: it pairs them by their order in the file
#
# Versions:   meshio 5.3.5, trimesh 5.2.0, numpy 2.4.6
# Behavior:  the face corners of an OBJ say which vt goes with which v (f 4/3). meshio's reader drops that and offers the
#             vt lines in order as point data "obj:vt". If there are as many vt as v, in another order, UVs are permuted
#             without a word; if there are more (any seam) it raises. Normals ("obj:vn") likewise.
# Output seen: a square whose faces say 1/1 2/2 4/3 and 1/1 4/3 3/4, as common exporters write a plane: the vertex at
#             (0, 1) gets UV (1, 1) and the one at (1, 1) gets (0, 1); trimesh: as the faces say
# One would guess: point data belong to the points.
# Who is hurt: whoever converts textured OBJ to PLY, VTK or XDMF with meshio: a twisted texture on half of the faces.
# Instead:    read OBJ with another library and hand meshio the points already split at seams.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check meshio==5.3.5 trimesh==5.2.0 numpy==2.4.6 scipy==1.17.1
cat > plane.obj <<'EOF'
v 0 0 0
v 1 0 0
v 0 1 0
v 1 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
f 1/1 2/2 4/3
f 1/1 4/3 3/4
EOF
env/bin/python - <<'EOF'
import meshio
import numpy as np
import trimesh

mesh = meshio.read("plane.obj")
uv = mesh.point_data["obj:vt"]
other = trimesh.load("plane.obj", process=False)
for point, found in zip(mesh.points, uv):
    right = other.visual.uv[np.abs(other.vertices - point).sum(1).argmin()]
    print(f"vertex {point[:2]}: meshio {found}, trimesh {right}")
assert np.allclose(other.visual.uv, other.vertices[:, :2])
assert np.allclose(uv[2], [1, 1]) and np.allclose(uv[3], [0, 1]), "meshio pairs UVs by the faces now"
with open("plane.obj") as file:
    text = file.read()
with open("seam.obj", "w") as file:
    file.write(text.replace("f 1/1 4/3 3/4", "vt 0.5 0\nf 1/5 4/3 3/4"))
try:
    meshio.read("seam.obj")
except Exception as error:
    print("with a seam:", type(error).__name__, error)
else:
    raise SystemExit("meshio reads seams now")
print("as described")
EOF
