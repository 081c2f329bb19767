#!/usr/bin/env bash
# MuJoCo: the distance to a geom of type "sdf" is the cut-off outside and a third of the depth inside
#
# Versions:   mujoco 4.0.0, numpy 2.4.6
# Behavior:  a mesh used by <geom type="sdf" mesh="..."/> is compiled to an octree of signed distances, but
#             mj_geomDistance answers from the contact solver: with no overlap it returns distmax whatever the gap, with
#             overlap some 0.37 of the depth, less when deep. The same mesh as type="mesh" (convex hull) answers right.
# Output seen: a ball of radius 0.2 at a gap of 0.30 from a unit sphere: mesh 0.300, sdf 10.000 (distmax); overlapping by
#             0.05: mesh -0.050, sdf -0.019; by 0.20: mesh -0.199, sdf -0.075
# One would guess: of all geoms the one made of signed distances knows its distance best.
# Who is hurt: planners, rewards and distance sensors that move from convex meshes to SDF geoms.
# Instead:    query the field yourself (a distance library on the mesh, or your own grid), and use the SDF geom for
#             contacts alone; or type="mesh" where the hull will do.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check mujoco==4.0.0 numpy==2.4.6
env/bin/python - <<'EOF'
import mujoco
import numpy as np

def sphere_obj(rows=24, cols=48):
    theta, phi = np.linspace(0, np.pi, rows + 1)[1:-1], np.arange(cols) * 2 * np.pi / cols
    ring = np.stack([np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi)),
                     np.outer(np.cos(theta), np.ones(cols))], -1).reshape(-1, 3)
    lines = [f"v {x:.8f} {y:.8f} {z:.8f}" for x, y, z in [*ring, (0, 0, 1), (0, 0, -1)]]
    for j in range(cols):
        k, last = (j + 1) % cols, (rows - 2) * cols
        lines += [f"f {len(ring) + 1} {j + 1} {k + 1}", f"f {len(ring) + 2} {last + k + 1} {last + j + 1}"]
        for i in range(rows - 2):
            a, b, c, d = i * cols + j + 1, (i + 1) * cols + j + 1, (i + 1) * cols + k + 1, i * cols + k + 1
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    return "\n".join(lines).encode()

def distances(kind, gaps):
    model = mujoco.MjModel.from_xml_string(f"""
        <mujoco><asset><mesh name="m" file="m.obj"/></asset><worldbody><geom type="{kind}" mesh="m"/>
        <body><freejoint/><geom type="sphere" size="0.2"/></body></worldbody></mujoco>""", assets={"m.obj": sphere_obj()})
    data = mujoco.MjData(model)
    found = []
    for gap in gaps:
        data.qpos[:3] = [1.2 + gap, 0, 0]
        mujoco.mj_forward(model, data)
        found.append(mujoco.mj_geomDistance(model, data, 0, 1, 10.0, None))
    print(kind, "at gaps", gaps, "says", np.round(found, 3).tolist())
    return np.array(found)

gaps = np.array([0.30, 0.05, -0.05, -0.20])
mesh, sdf = distances("mesh", gaps.tolist()), distances("sdf", gaps.tolist())
assert np.allclose(mesh, gaps, atol=0.01)
assert (sdf[:2] == 10).all(), "distances outside are known now"
assert (sdf[2:] < 0).all() and (sdf[2:] / gaps[2:] < 0.6).all(), "depths are right now"
print("as described")
EOF
