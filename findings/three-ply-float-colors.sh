#!/usr/bin/env bash
# three.js, Open3D: vertex colors of a PLY by three's PLYExporter are all but black in Open3D, whatever they were stored as
#
# Versions:   three 0.187.0, open3d-cpu 0.20.0, numpy 2.4.6
# Behavior:  PLYExporter writes `property float red`, 0 to 1, also where the geometry has normalized bytes and where PLYLoader
#             read `uchar`. Open3D's readers of meshes and its legacy reader of points take any number for 0 to 255 and
#             divide by 255; t.io.read_point_cloud looks at the type and is right. No one warns.
# Output seen: red, grey, white as uchar 255 0 0, 128 128 128, 255 255 255 through PLYLoader and PLYExporter, text or binary:
#             by io and t.io.read_triangle_mesh and io.read_point_cloud .0039 0 0, .002 .002 .002, .0039 .0039 .0039; by
#             t.io.read_point_cloud 1 0 0, .5 .5 .5, 1 1 1
# One would guess: bytes are written as bytes, as every tool reads them; a reader looks at the type that stands in the header.
# Who is hurt: scans and vertex-painted models edited on a page and taken to Python: all but black, and still varied enough
#             to pass a test for not being empty.
# Instead:    in Open3D t.io.read_point_cloud, or colors times 255 where the header says float; assimp and OpenMesh heed it.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm install --silent --no-save --no-audit --no-fund --prefix . three@0.187.0
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check open3d-cpu==0.20.0 numpy==2.4.6
cat > write.mjs <<'EOF'
import fs from 'node:fs';
import { Mesh } from 'three';
import { PLYExporter } from 'three/addons/exporters/PLYExporter.js';
import { PLYLoader } from 'three/addons/loaders/PLYLoader.js';

const source = fs.readFileSync('source.ply', 'utf8');
const geometry = new PLYLoader().parse(source);
const color = geometry.attributes.color;
console.log('PLYLoader gives', color.array.constructor.name, color.normalized ? 'normalized' : '');
for (const binary of [false, true]) {
  const out = new PLYExporter().parse(new Mesh(geometry), null, { binary, littleEndian: true });
  fs.writeFileSync(binary ? 'binary.ply' : 'text.ply', binary ? new Uint8Array(out) : out);
}
EOF
cat > source.ply <<'EOF'
ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 1
property list uchar int vertex_indices
end_header
0 0 0 255 0 0
1 0 0 128 128 128
0 1 0 255 255 255
3 0 1 2
EOF
node write.mjs
env/bin/python - <<'EOF'
import numpy as np
import open3d

readers = {
    "mesh": lambda path: np.asarray(open3d.io.read_triangle_mesh(path).vertex_colors),
    "tensor mesh": lambda path: open3d.t.io.read_triangle_mesh(path).vertex.colors.numpy(),
    "points": lambda path: np.asarray(open3d.io.read_point_cloud(path).colors),
    "tensor points": lambda path: open3d.t.io.read_point_cloud(path).point.colors.numpy(),
}
wanted = np.array([[1, 0, 0], [0.502, 0.502, 0.502], [1, 1, 1]])
found = {(name, path): read(path) for name, read in readers.items() for path in ("source.ply", "text.ply", "binary.ply")}
for (name, path), colors in found.items():
    print(f"{name}, {path}: {colors.dtype}", *(" ".join(f"{x:.4g}" for x in row) for row in colors), sep=" | ")
header = open("text.ply").read().split("end_header")[0]

assert "property float red" in header and "uchar red" not in header, "three.js writes bytes now"
for path in ("text.ply", "binary.ply"):
    assert np.allclose(found["tensor points", path], wanted, atol=0.005)
    for name in ("mesh", "tensor mesh", "points"):
        assert 0.003 < found[name, path].max() < 0.005, "Open3D heeds the type now"
assert np.allclose(found["mesh", "source.ply"], wanted, atol=0.005)
assert np.allclose(found["points", "source.ply"], wanted, atol=0.005)
print("as described")
EOF
