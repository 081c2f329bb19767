#!/usr/bin/env bash
# meshoptimizer (Python): simplify reads the wrong vertices from an array that is a view, without a word
#
# Versions:   meshoptimizer 0.2.30a0 (Python), numpy 2.4.6
# Behavior:  the wrapper hands C the array's first address and a stride computed from shape and item size; NumPy's own
#             strides are not looked at. vertices[:, :3] of an interleaved float32 array, or a Fortran-ordered one, is
#             read as if packed: positions are made of normals and UVs. float64 input hides it (the cast makes a copy),
#             and so does encode_vertex_buffer, which copies first. simplify_with_attributes and the optimizers share it.
# Output seen: a torus of 4,096 triangles, 400 asked for, error up to 0.02: packed 400; the same numbers as a view of an
#             (n, 8) array 3,058; Fortran order 3,070; float64 view 400. Indices are valid, so nothing fails
# One would guess: a NumPy function takes any NumPy array, or refuses one that is not contiguous.
# Who is hurt: whoever keeps vertices interleaved as GPUs want them, and passes a slice.
# Instead:    numpy.ascontiguousarray(positions, dtype=numpy.float32) before every call; indices as flat uint32.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check meshoptimizer==0.2.30a0 numpy==2.4.6
env/bin/python - <<'EOF'
import meshoptimizer
import numpy as np

# A torus of 64 x 32 quads.
n, m = 64, 32
a, b = (x.ravel() for x in np.meshgrid(np.arange(n) * 2 * np.pi / n, np.arange(m) * 2 * np.pi / m, indexing="ij"))
normal = np.stack([np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)], 1)
position = np.stack([np.cos(a), np.sin(a), 0 * a], 1) + 0.4 * normal
i, j = (x.ravel() for x in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
corner = lambda di, dj: ((i + di) % n) * m + (j + dj) % m  # noqa: E731
faces = np.vstack([np.c_[corner(0, 0), corner(1, 0), corner(1, 1)], np.c_[corner(0, 0), corner(1, 1), corner(0, 1)]])
indices = np.ascontiguousarray(faces.ravel(), np.uint32)

interleaved = np.zeros((n * m, 8), np.float32)  # position, normal, uv
interleaved[:, :3], interleaved[:, 3:6] = position, normal
view = interleaved[:, :3]
packed = np.ascontiguousarray(view)
assert np.array_equal(view, packed)

def volume(tris):
    p, q, r = (position[tris[:, k]] for k in range(3))
    return float((p * np.cross(q, r)).sum() / 6)

def simplify(vertices):
    out, error = np.zeros(len(indices), np.uint32), np.zeros(1, np.float32)
    count = meshoptimizer.simplify(out, indices, vertices, target_index_count=3 * 400, target_error=0.02, result_error=error)
    return out[:count].reshape(-1, 3), float(error[0])

results = {"packed": simplify(packed), "view": simplify(view), "fortran": simplify(np.asfortranarray(packed)),
           "float64 view": simplify(interleaved.astype(float)[:, :3])}
print(f"source: {len(faces)} triangles, volume {volume(faces):.3f}")
for name, (tris, error) in results.items():
    print(f"{name}: {len(tris)} triangles, volume {volume(tris):.3f}, error said {error:.3f}")
good = results["packed"][0]
assert np.array_equal(results["float64 view"][0], good)
assert not np.array_equal(results["view"][0], good), "views are read right now"
assert not np.array_equal(results["fortran"][0], good), "Fortran order is read right now"
assert np.array_equal(results["view"][0], simplify(view)[0])
print("as described")
EOF
