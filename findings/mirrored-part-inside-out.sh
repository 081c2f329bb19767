#!/usr/bin/env bash
# A mirrored part (a node with a negative scale) comes out inside out from VTK, assimp and three.js' exporters
#
# Versions:   pyvista 0.49.1 on vtk 9.7.2, assimp-py 1.1.0, trimesh 5.2.0, numpy 2.4.6; npm three 0.187.0
# Behavior:  glTF says that a node transform of negative determinant turns the winding over, so that outside stays
#             outside. VTK's glTF reader and assimp's PreTransformVertices apply the matrix and keep the index order;
#             three.js draws it right, but its OBJExporter and STLExporter write it the same wrong way (the STL with
#             facet normals that point inwards). trimesh does turn the faces over.
# Output seen: signed volume of a mirrored closed unit box: trimesh +1, vtk -1, assimp -1, three OBJ -1, three STL -1
# One would guess: who bakes a transform into vertices keeps the outside outside.
# Who is hurt: the left half of every symmetrical asset: back-face culling hides it, SDF signs, volumes and normals
#             computed from faces are reversed for that part only.
# Instead:    after reading, check the sign of the determinant of each node's matrix and reverse the triangles.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check pyvista==0.49.1 vtk==9.7.2 assimp-py==1.1.0 trimesh==5.2.0 \
    numpy==2.4.6 scipy==1.17.1
npm install --silent --no-save --no-audit --no-fund --prefix . three@0.187.0
cat > write.mjs <<'EOF'
import { writeFileSync } from 'node:fs';
import * as THREE from 'three';
import { OBJExporter } from 'three/examples/jsm/exporters/OBJExporter.js';
import { STLExporter } from 'three/examples/jsm/exporters/STLExporter.js';

const box = new THREE.Mesh(new THREE.BoxGeometry(1, 1, 1));
box.scale.x = -1;
box.updateMatrixWorld();
writeFileSync('three.obj', new OBJExporter().parse(box));
writeFileSync('three.stl', new STLExporter().parse(box));
EOF
node write.mjs
env/bin/python - <<'EOF'
import json

import assimp_py
import numpy as np
import pyvista
import trimesh

def volume(points, faces):
    a, b, c = (np.asarray(points, float)[np.asarray(faces)[:, k]] for k in range(3))
    return float((a * np.cross(b, c)).sum() / 6)

box = trimesh.creation.box()
box.export("box.glb")
with open("box.glb", "rb") as file:
    data = file.read()
size = int.from_bytes(data[12:16], "little")
document = json.loads(data[20:20 + size])
[node] = [n for n in document["nodes"] if "mesh" in n]
node.pop("matrix", None)
node["scale"] = [-1, 1, 1]
text = json.dumps(document).encode()
text += b" " * (-len(text) % 4)
body = data[20 + size:]
with open("mirrored.glb", "wb") as file:
    file.write(data[:8] + (20 + len(text) + len(body)).to_bytes(4, "little") + len(text).to_bytes(4, "little") + b"JSON" + text + body)

found = {}
mesh = trimesh.load("mirrored.glb").to_mesh()
found["trimesh"] = volume(mesh.vertices, mesh.faces)
surface = pyvista.read("mirrored.glb").combine().extract_surface(algorithm="dataset_surface").triangulate()
found["vtk"] = volume(surface.points, surface.faces.reshape(-1, 4)[:, 1:])
scene = assimp_py.import_file("mirrored.glb", assimp_py.Process_Triangulate | assimp_py.Process_PreTransformVertices)
part = scene.meshes[0]
found["assimp"] = volume(np.array(part.vertices).reshape(-1, 3), np.array(part.indices).reshape(-1, 3))
for kind in ("obj", "stl"):
    mesh = trimesh.load(f"three.{kind}", process=False)
    found[f"three {kind}"] = volume(mesh.vertices, mesh.faces)
for name, value in found.items():
    print(f"{name}: signed volume {value:+.3f}")
assert abs(found.pop("trimesh") - 1) < 1e-6
for name, value in found.items():
    assert abs(value + 1) < 1e-6, f"{name} turns the faces over now"
print("as described")
EOF
