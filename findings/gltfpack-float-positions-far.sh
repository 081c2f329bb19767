#!/usr/bin/env bash
# gltfpack -vpf ("floating point attributes for positions") is 300 times less exact than its integers, far from the origin
#
# Versions:   npm gltfpack 1.3.0; trimesh 5.2.0 to write and read, numpy 2.4.6
# Behavior:  with -vpf positions are floats, but each is rounded to the -vp bits (14) of its own mantissa, so the error
#             grows with the distance from the origin, where the default integers' error is a share of the box alone.
#             -vp 16, the most there is, makes it four times smaller. Only -noq leaves floats alone.
# Output seen: a sphere of radius 0.5 at x = 1000: default 4.6e-05, -vpf 1.6e-02, -vpf -vp 16 3.9e-03, -noq 0
# One would guess: floats are kept, or are at least as good as 14-bit integers.
# Who is hurt: who takes -vpf because a reader knows no KHR_mesh_quantization: scans, maps, buildings and parts placed
#             by their vertices; seams of neighbouring parts open, small parts fall into steps.
# Instead:    -noq, or the default; or move the mesh to the origin and put the offset into the node.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check trimesh==5.2.0 numpy==2.4.6 scipy==1.17.1
npm install --silent --no-save --no-audit --no-fund --prefix . gltfpack@1.3.0
env/bin/python - <<'EOF'
import subprocess

import numpy as np
import trimesh

def error(offset, *flags):
    """Largest distance from a vertex of the packed file to the vertex it was."""
    sphere = trimesh.creation.icosphere(3, radius=0.5)
    sphere.apply_translation([offset, 0, 0])
    sphere.export("source.glb")
    subprocess.run(["node_modules/.bin/gltfpack", "-i", "source.glb", "-o", "packed.glb", *flags], check=True)
    packed = np.array(trimesh.load("packed.glb").to_mesh().vertices)
    source = np.array(sphere.vertices, np.float32).astype(float)
    worst = np.linalg.norm(packed[:, None] - source[None], axis=2).min(1).max()
    print(f"at x = {offset}, {' '.join(flags) or 'default'}: {worst:.1e}")
    return worst

near, near_float = error(0), error(0, "-vpf")
far, far_float, far_most, exact = error(1000), error(1000, "-vpf"), error(1000, "-vpf", "-vp", "16"), error(1000, "-noq")
assert near_float < near < 1e-4 and far < 1e-4 and exact < 1e-6
assert far_float > 100 * far, "-vpf is exact enough now"
assert far_most > 20 * far, "-vp 16 is exact enough now"
print("as described")
EOF
