#!/usr/bin/env bash
# assimp, Open3D: a glTF's UVs in 8 or 16 bits are read as bits of floats: NaN or 0, and quantized models fall into a point
#
# Versions:   assimp-py 1.1.0, open3d-cpu 0.20.0 (its own assimp), numpy 2.4.6
# Behavior:  both take the bytes of each element of an accessor for floats, whatever its componentType, and leave the rest
#             0: the two 16-bit numbers of a UV become one float, v is always 0. TEXCOORD_0 in normalized bytes and shorts is
#             core glTF 2.0, no extension. KHR_mesh_quantization in extensionsRequired, which a loader that lacks it must
#             refuse, is passed over, and positions fare as UVs do. COLOR_0 without alpha gets alpha 0 from assimp, where
#             the format says 1. Nothing is raised, nothing logged.
# Output seen: u .125 .75 .75 .125, v .25 .25 1 1: as floats they come back; as shorts u 2.002 2.012 nan nan, v 0; as bytes
#             u and v 0; positions of 0 .. 100 in bytes, scaled by .01: all within 1e-30 of the origin; alpha of RGB colors: 0
# One would guess: 0.75 whatever holds it, or an error.
# Who is hurt: files by gltfpack (every position 0) and by gltf-transform quantize (NaN) in anything built upon assimp; textures
#             are one flat color, NaN spreads into bakes and losses; colored meshes are invisible where alpha counts.
# Instead:    VTK's reader reads such UVs right and refuses the extension; or have floats written (gltfpack -noq).
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check assimp-py==1.1.0 open3d-cpu==0.20.0 numpy==2.4.6
env/bin/python - <<'EOF'
import json
import struct

import assimp_py
import numpy as np
import open3d

square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
uv = np.array([[0.125, 0.25], [0.75, 0.25], [0.75, 1], [0.125, 1]], np.float32)
rgb = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], np.float32)
CODES = {"float32": 5126, "uint8": 5121, "uint16": 5123}

def write(path, attributes, **node):
    """A GLB of a square from arrays by attribute; integers of a UV are normalized, elements begin at multiples of four bytes."""
    data, views, accessors = b"", [], []
    for array in [*attributes.values(), np.array([0, 1, 2, 0, 2, 3], np.uint16)]:
        rows = array.reshape(len(array), -1)
        padded = np.zeros((len(rows), -(-rows.shape[1] * rows.itemsize // 4) * 4), np.uint8)
        padded[:, : rows.shape[1] * rows.itemsize] = rows.view(np.uint8)
        view = {"buffer": 0, "byteOffset": len(data)}
        accessor = {"bufferView": len(views), "componentType": CODES[array.dtype.name], "count": len(array), "type": "SCALAR"}
        if array.ndim == 2:
            accessor["type"] = f"VEC{array.shape[1]}"
            view["byteStride"] = padded.shape[1]
            accessor |= {"min": array.min(0).tolist(), "max": array.max(0).tolist()} if array.shape[1] == 3 else {}
            accessor |= {"normalized": True} if array.shape[1] == 2 and array.dtype != np.float32 else {}
            stored = padded.tobytes()
        else:
            stored = array.tobytes()
        views.append(view | {"byteLength": len(stored)})
        data += stored
        accessors.append(accessor)
    primitive = {"attributes": {name: i for i, name in enumerate(attributes)}, "indices": len(attributes)}
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0} | node],
            "meshes": [{"primitives": [primitive]}], "accessors": accessors, "bufferViews": views,
            "buffers": [{"byteLength": len(data)}]}
    if attributes["POSITION"].dtype != np.float32:
        gltf |= {"extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"]}
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    size = 28 + len(text) + len(data)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sIII4s", b"glTF", 2, size, len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(data), b"BIN\0") + data)

def by_assimp(path):
    """Positions, UVs as in the file (assimp turns v over) and colors."""
    mesh = assimp_py.import_file(path, assimp_py.Process_Triangulate | assimp_py.Process_PreTransformVertices).meshes[0]
    positions = np.array(mesh.vertices).reshape(-1, 3)
    found = np.array(mesh.texcoords[0]).reshape(len(positions), -1)[:, :2]
    colors = np.array(mesh.colors[0]).reshape(-1, 4) if mesh.colors else None
    return positions, found * [1, -1] + [0, 1], colors

def by_open3d(path):
    """Positions and UVs as in the file; Open3D has them by the corners of triangles."""
    mesh = open3d.io.read_triangle_mesh(path)
    positions, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    found = np.zeros((len(positions), 2))
    found[triangles.ravel()] = np.asarray(mesh.triangle_uvs) * [1, -1] + [0, 1]
    return positions, found, None

write("float.glb", {"POSITION": square, "TEXCOORD_0": uv, "COLOR_0": rgb})
write("short.glb", {"POSITION": square, "TEXCOORD_0": np.round(uv * 65535).astype(np.uint16)})
write("byte.glb", {"POSITION": square, "TEXCOORD_0": np.round(uv * 255).astype(np.uint8)})
write("quantized.glb", {"POSITION": (square * 100).astype(np.uint8), "TEXCOORD_0": uv}, scale=[0.01, 0.01, 0.01])
for read in (by_assimp, by_open3d):
    found = {name: read(f"{name}.glb") for name in ("float", "short", "byte", "quantized")}
    for name in ("float", "short", "byte"):
        print(read.__name__, f"{name}: u", *found[name][1][:, 0].round(3), "v", *found[name][1][:, 1].round(3))
    extent = float(np.abs(found["quantized"][0]).max())
    print(read.__name__, "quantized: the farthest coordinate is", extent)
    assert np.allclose(found["float"][1], uv)
    assert np.allclose(found["short"][0], square)
    assert np.isnan(found["short"][1][2:, 0]).all(), "shorts are read right now"
    assert np.allclose(found["short"][1][:2, 0], [2.00195, 2.01172], atol=1e-4)
    assert not found["short"][1][:, 1].any() and np.abs(found["byte"][1]).max() < 1e-30, "bytes are read right now"
    assert extent < 1e-30, "quantized positions are read right or refused now"
alpha = by_assimp("float.glb")[2][:, 3]
print("by_assimp alpha of colors without alpha:", *alpha)
assert not alpha.any(), "alpha is 1 now"
print("as described")
EOF
