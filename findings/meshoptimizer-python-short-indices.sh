#!/usr/bin/env bash
# meshoptimizer (Python): indices decoded as 2 bytes each come back packed in pairs, half of the array zeros
#
# Versions:   meshoptimizer 0.2.30a0 (Python), numpy 2.4.6
# Behavior:  decode_index_buffer and decode_index_sequence take index_size 2 or 4, as the size of each index. With 2 the
#             library writes 16-bit numbers into an array that the wrapper makes of uint32 whatever the size: each entry
#             holds two indices, and the second half stays 0. The array has the right length and nothing is raised.
# Output seen: 0 1 2 2 1 3 with size 4; 65536 131074 196609 0 0 0 with size 2
# One would guess: index_size=2 gives the same indices, as uint16 or widened.
# Who is hurt: whoever reads EXT_meshopt_compression and passes byteStride on: most glTF files have 16-bit indices.
# Instead:    always ask for 4 and narrow the result; or view it: decoded.view(numpy.uint16)[:count].
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv env
env/bin/pip install -q --disable-pip-version-check meshoptimizer==0.2.30a0 numpy==2.4.6
env/bin/python - <<'EOF'
import meshoptimizer
import numpy as np

indices = np.array([0, 1, 2, 2, 1, 3], np.uint32)
pairs = [
    (meshoptimizer.encode_index_buffer, meshoptimizer.decode_index_buffer),
    (meshoptimizer.encode_index_sequence, meshoptimizer.decode_index_sequence),
]
for encode, decode in pairs:
    data = encode(indices)
    wide, short = decode(len(indices), 4, data), decode(len(indices), 2, data)
    print(decode.__name__, "size 4:", *wide, "size 2:", *short)
    assert len(wide) == len(short) == len(indices)
    assert sorted(wide.tolist()) == sorted(indices.tolist())
    assert not np.array_equal(short, wide), "short indices are unpacked right now"
    assert not short[3:].any()
    assert np.array_equal(short.view(np.uint16)[: len(indices)], wide)
print("as described")
EOF
