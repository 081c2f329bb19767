#!/usr/bin/env bash
# trimesh: every OBJ saved as GLB is polished metal, and darker
#
# Versions:   trimesh 5.2.0, Pillow 13.0.0; beside it npm obj2gltf 3.2.0
# Behavior:  trimesh's conversion of an OBJ's material to glTF writes roughnessFactor but no metallicFactor, and glTF's
#             default for that is 1.0: full metal. A material with an image but no Kd gets Kd 0.4 and so
#             baseColorFactor 0.4, linear. `d 0.5` (opacity) is lost.
# Output seen: trimesh: metallicFactor absent (= 1), baseColorFactor [0.4, 0.4, 0.4, 1], alphaMode absent
#             obj2gltf on the same file: metallicFactor 0, baseColorFactor [1, 1, 1, 0.5], alphaMode BLEND
# One would guess: plain MTL knows no metal, so the GLB is a dielectric with the colours of the image.
# Who is hurt: whoever converts OBJ data sets with trimesh and renders them: without an environment map they are black.
# Instead:    give each material a PBRMaterial(metallicFactor=0.0, baseColorFactor=..., ...) before export; or obj2gltf.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check trimesh==5.2.0 Pillow==13.0.0 numpy==2.4.6 scipy==1.17.1
npm install --silent --no-save --no-audit --no-fund --prefix . obj2gltf@3.2.0
cat > paint.mtl <<'EOF'
newmtl paint
map_Kd paint.png
d 0.5
EOF
cat > square.obj <<'EOF'
mtllib paint.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl paint
f 1/1 2/2 3/3
f 1/1 3/3 4/4
EOF
env/bin/python -c "from PIL import Image; Image.new('RGB', (8, 8), (200, 90, 30)).save('paint.png')"
env/bin/python -c "import trimesh; trimesh.load('square.obj').export('trimesh.glb')"
node_modules/.bin/obj2gltf -i square.obj -o obj2gltf.glb > /dev/null
env/bin/python - <<'EOF'
import json

def material(path):
    with open(path, "rb") as file:
        head = file.read(20)
        found = json.loads(file.read(int.from_bytes(head[12:16], "little")))["materials"][0]
    print(path, json.dumps(found))
    return found

ours, other = material("trimesh.glb"), material("obj2gltf.glb")
pbr = ours["pbrMetallicRoughness"]
assert pbr.get("metallicFactor", 1.0) == 1.0, "no longer metal"
assert pbr["baseColorFactor"] == [0.4, 0.4, 0.4, 1.0], "no longer darkened"
assert "alphaMode" not in ours, "opacity is kept now"
assert other["pbrMetallicRoughness"]["metallicFactor"] == 0
print("as described")
EOF
