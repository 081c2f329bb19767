#!/usr/bin/env bash
# trimesh: loading a GLB and saving it re-compresses its JPEGs at quality 75 and forgets how textures wrap
#
# Versions:   trimesh 5.2.0, Pillow 13.0.0, numpy 2.4.6
# Behavior:  load().export() of a GLB with nothing done in between decodes each image and writes a JPEG anew at Pillow's
#             default quality with 4:2:0 chroma; samplers (clamp, mirrored repeat, nearest), normalTexture.scale and
#             occlusionTexture.strength are gone, without a word. Factors, alpha mode and names are kept.
# Output seen: JPEG 52 kB -> 13 kB, rms error against the original picture 1.3 -> 5.7 of 255; no samplers;
#             normalTexture {"index": 1}, occlusionTexture {"index": 2}
# One would guess: who moves a vertex gets the same images back, byte for byte, as other glTF libraries do.
# Who is hurt: pipelines that pass textured assets through trimesh for a small edit; and each pass costs again. Clamped
#             decals repeat; normal maps become twice as flat or steep.
# Instead:    edit GLBs with gltf-transform or pygltflib; or take images from the source file and put them back.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check trimesh==5.2.0 Pillow==13.0.0 numpy==2.4.6 scipy==1.17.1
env/bin/python - <<'EOF'
import io
import json

import numpy as np
import trimesh
from PIL import Image

def write_glb(path, document, binary):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    parts = [b"glTF", (2).to_bytes(4, "little"), (28 + len(text) + len(binary)).to_bytes(4, "little"),
             len(text).to_bytes(4, "little"), b"JSON", text, len(binary).to_bytes(4, "little"), b"BIN\0", binary]
    with open(path, "wb") as file:
        file.write(b"".join(parts))

def read_glb(path):
    with open(path, "rb") as file:
        data = file.read()
    size = int.from_bytes(data[12:16], "little")
    return json.loads(data[20:20 + size]), data[28 + size:]

y, x = np.mgrid[0:256, 0:256]
picture = np.stack([128 + 100 * np.sin(x / 3), 128 + 100 * np.cos(y / 5), 128 + 100 * np.sin((x + y) / 4)], -1).astype("u1")
jpeg = io.BytesIO()
Image.fromarray(picture).save(jpeg, "JPEG", quality=97, subsampling=0)
source = jpeg.getvalue()
points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "f4")
chunks = [points.tobytes(), (points[:, :2] * 2).tobytes(), np.array([0, 1, 2, 0, 2, 3], "u2").tobytes(), source]
offsets = np.cumsum([0] + [len(c) for c in chunks]).tolist()
write_glb("source.glb", {
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
        {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
        {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteOffset": o, "byteLength": len(c)} for o, c in zip(offsets, chunks)],
    "buffers": [{"byteLength": offsets[-1]}],
    "images": [{"bufferView": 3, "mimeType": "image/jpeg"}],
    "samplers": [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}],  # clamp, mirrored repeat, nearest
    "textures": [{"source": 0, "sampler": 0}],
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
                   "normalTexture": {"index": 0, "scale": 2.0},
                   "occlusionTexture": {"index": 0, "strength": 0.25}}]}, b"".join(chunks))

trimesh.load("source.glb").export("again.glb")
document, binary = read_glb("again.glb")
view = document["bufferViews"][document["images"][0]["bufferView"]]
again = binary[view.get("byteOffset", 0):][:view["byteLength"]]

def rms(data):
    return float(np.sqrt(((np.asarray(Image.open(io.BytesIO(data)), float) - picture) ** 2).mean()))

material = document["materials"][0]
print(f"JPEG {len(source)} bytes -> {len(again)}; rms error {rms(source):.1f} -> {rms(again):.1f}")
print("samplers:", document.get("samplers"), "material:", json.dumps(material))
assert again != source and len(again) < len(source) / 2 and rms(again) > 3 * rms(source), "images are kept now"
assert not document.get("samplers"), "samplers are kept now"
assert "scale" not in material["normalTexture"] and "strength" not in material["occlusionTexture"], "kept now"
print("as described")
EOF
