#!/usr/bin/env bash
# trimesh: merging textured meshes turns their colours into negatives, and dielectrics into metal
#
# Versions:   trimesh 5.2.0, Pillow 13.0.0, numpy 2.4.6
# Behavior:  Scene.to_mesh(), load(force="mesh") and util.concatenate pack several PBR materials into one atlas. The
#             base colour texture is multiplied by baseColorFactor, which trimesh keeps as bytes 0..255, and the
#             product is cast to 8 bits: a texel of 200 times factor 1.0 gives 200 x 255 mod 256 = 56. So a factor of
#             [1, 1, 1, 1], which exporters write and which means "leave it", inverts the image. (The cast out of range
#             is the platform's; on x86 it wraps.) metallicFactor goes to the red channel, which nobody reads, and
#             is then dropped: metallicFactor 0 over a metallic-roughness texture becomes metal. A normal map that not
#             all materials have disappears.
# Output seen: texel 200 with no factor: 200; with factor 1.0: 56; with factor 0.5: 0; metallic (blue) 255, factor None
# One would guess: the look is kept; the name says to_mesh, not repaint.
# Who is hurt: data sets made with load(force="mesh"): Objaverse-like pipelines, renderers, colour training.
# Instead:    keep the Scene and go through its geometries; or set baseColorFactor = None before merging where it is 1.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check trimesh==5.2.0 Pillow==13.0.0 numpy==2.4.6 scipy==1.17.1
env/bin/python - <<'EOF'
import numpy as np
import trimesh
from PIL import Image
from trimesh.visual.material import PBRMaterial

def quad(x, material):
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    look = trimesh.visual.TextureVisuals(uv=corners[:, :2], material=material)
    return trimesh.Trimesh(corners + [x, 0, 0], [[0, 1, 2], [0, 2, 3]], process=False, visual=look)

def merged(factor):
    """A grey quad of the given baseColorFactor beside a blue one: through a GLB, then to_mesh."""
    grey = PBRMaterial(name="grey", baseColorTexture=Image.new("RGB", (64, 64), (200, 200, 200)),
                       baseColorFactor=factor, metallicFactor=0.0, roughnessFactor=1.0,
                       metallicRoughnessTexture=Image.new("RGB", (64, 64), (0, 128, 255)),
                       normalTexture=Image.new("RGB", (64, 64), (128, 128, 255)))
    blue = PBRMaterial(name="blue", baseColorTexture=Image.new("RGB", (64, 64), (10, 10, 200)))
    trimesh.Scene([quad(0, grey), quad(2, blue)]).export("two.glb")
    mesh = trimesh.load("two.glb").to_mesh()
    material = mesh.visual.material
    face = int(np.argmin(mesh.triangles_center[:, 0]))  # one of the grey quad
    u, v = mesh.visual.uv[mesh.faces[face]].mean(0)

    def texel(image):
        return image.getpixel((int(u * image.width), int((1 - v) * image.height)))

    print(f"factor {factor}: base colour {texel(material.baseColorTexture)}, "
          f"metallic-roughness {texel(material.metallicRoughnessTexture)}, metallicFactor {material.metallicFactor}, "
          f"normal map {material.normalTexture}")
    return texel(material.baseColorTexture)[0], texel(material.metallicRoughnessTexture)[2], material

none, _, _ = merged(None)
one, metal, material = merged([1.0, 1.0, 1.0, 1.0])
half, _, _ = merged([0.5, 0.5, 0.5, 1.0])
assert none == 200
assert one != 200, "a factor of one no longer changes the colour"
assert half not in range(90, 160), "a factor of a half now darkens as it should"
assert metal == 255 and material.metallicFactor is None, "metallicFactor 0 is kept now"
assert material.normalTexture is None, "the normal map is kept now"
print("as described")
EOF
