#!/usr/bin/env bash
# trimesh reads the integer UVs of a gltfpack file raw, and wraps them around in 16 bits
#
# Versions:   trimesh 5.2.0, Pillow 13.0.0, numpy 2.4.6; npm gltfpack 1.3.0
# Behavior:  glTF allows UVs as normalized unsigned bytes or shorts without any extension, and gltfpack writes them
#             so by default (with KHR_texture_transform). trimesh ignores `normalized` and the texture transform, and
#             turns v over as 1 - v in the integers' own type: 4095 becomes 61442. No error, no warning; positions
#             are right, as gltfpack scales those in the node.
# Output seen: source UVs from 0 to 1; after gltfpack u from 0 to 4095 and v from 1 to 65025
# One would guess: floats in 0..1, or a refusal: the accessor says `normalized: true`.
# Who is hurt: whoever measures or trains on UVs of files from the web; textures look like noise. Dividing by 65535
#             afterwards mends u (up to the texture transform) but not v.
# Instead:    run `gltfpack -noq`, or gltf-transform's dequantize, or read the accessors yourself; refuse |uv| > 1000.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check trimesh==5.2.0 Pillow==13.0.0 numpy==2.4.6 scipy==1.17.1
npm install --silent --no-save --no-audit --no-fund --prefix . gltfpack@1.3.0
cat > write.py <<'EOF'
import numpy as np
import trimesh
from PIL import Image

n = 9
u, v = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n)))
i = np.arange(n * n).reshape(n, n)
a, b, c, d = i[:-1, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel(), i[1:, :-1].ravel()
faces = np.vstack([np.c_[a, b, c], np.c_[a, c, d]])
look = trimesh.visual.TextureVisuals(uv=np.c_[u, v], image=Image.new("RGB", (8, 8), (200, 90, 30)))
trimesh.Trimesh(np.c_[u, v, 0 * u], faces, process=False, visual=look).export("source.glb")
EOF
cat > read.py <<'EOF'
import numpy as np
import trimesh

def uv_of(path):
    mesh = trimesh.load(path).to_mesh()
    print(f"{path}: bounds {mesh.bounds.round(3).tolist()}, uv from {mesh.visual.uv.min(0)} to {mesh.visual.uv.max(0)}")
    return mesh.visual.uv, mesh.bounds

before, box = uv_of("source.glb")
exact, _ = uv_of("exact.glb")
after, box_after = uv_of("packed.glb")
assert np.allclose(box, box_after, atol=1e-3)
assert before.max() <= 1 and exact.max() <= 1
assert after[:, 0].max() == 4095, "u is no longer raw"
assert after[:, 1].max() > 60000, "v no longer wraps around"
print("as described")
EOF
env/bin/python write.py
node_modules/.bin/gltfpack -i source.glb -o packed.glb
node_modules/.bin/gltfpack -i source.glb -o exact.glb -noq
env/bin/python read.py
