"""SHA-256 digests of what the codec does: tiny fits, answers and meshes of the conformance files.

`python -m tests.behavior.digests` writes `expected.json` beside this file; with `--check` it
compares and exits with 1 where anything differs. Weights and answers depend on the processor's
matrix products, so that digests hold for one machine class: the file says which.
"""

from __future__ import annotations

import hashlib
import json
import platform
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import nispcodec
from nispcodec import EncodeConfig, TexturedMesh
from nispcodec.format import pack
from nispcodec.io.write.glb import glb_bytes
from nispcodec.procedural.mug import sample_asset
from tests.encode.tunings import small
from tests.geometry.shapes import box_asset, hemisphere, soup

EXPECTED = Path(__file__).with_name("expected.json")
CONFORMANCE = Path(__file__).parent.parent / "conformance"


def main() -> int:
    """Write or check; returns the exit code."""
    found = {"machine": machine(), "fits": dict(fits()), "conformance": dict(conformance())}
    if "--check" not in sys.argv:
        EXPECTED.write_text(json.dumps(found, indent=1) + "\n")
        return 0
    expected = json.loads(EXPECTED.read_text())
    differing = [
        f"{group}: {name}"
        for group in ("machine", "fits", "conformance")
        for name in expected[group]
        if found[group].get(name) != expected[group][name]
    ]
    print(
        "\n".join(differing)
        or f"{len(found['fits'])} fits, {len(found['conformance'])} files: same"
    )
    return int(bool(differing))


def machine() -> dict[str, str]:
    """What the digests depend on besides the code."""
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    model = next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    return {"processor": model, "python": platform.python_version(), "numpy": np.__version__}


def fits() -> Iterator[tuple[str, str]]:
    """Name and digest of the bytes of every tiny fit."""
    cases: dict[str, tuple[TexturedMesh, EncodeConfig]] = {
        "box, balanced": (box_asset(), EncodeConfig(geometry="field")),
        "box, seed 7": (box_asset(), EncodeConfig(geometry="field", seed=7)),
        "box, paper": (box_asset(), EncodeConfig("paper")),
        "box, pruned": (box_asset(), EncodeConfig(prune="smallest", prune_rate=0.4)),
        "mug, fast": (
            sample_asset(),
            EncodeConfig("fast", geometry="field", seed=1, textures=False),
        ),
        "mug, best, padded": (
            sample_asset(),
            EncodeConfig("best", geometry="field", pad_textures=True),
        ),
        "mug, 4 kB": (
            sample_asset(),
            EncodeConfig(geometry="field", target_size=4000, textures=False),
        ),
        "hemisphere": (soup(hemisphere()), EncodeConfig(geometry="field", seed=3)),
    }
    tuning = small(6000, 200, 3, 50, 100)
    for name, (mesh, config) in cases.items():
        yield name, digest(pack(nispcodec.encode(mesh, config, tuning=tuning).document))


def conformance() -> Iterator[tuple[str, str]]:
    """Name and digest of the answers, and of the mesh, of every conformance file."""
    points = np.random.default_rng(0).uniform(-1, 1, (500, 3))
    for path in sorted(CONFORMANCE.glob("*.nisp")):
        model = nispcodec.load(path)
        world = model.document.frame.to_world(points)
        answers = (model.sdf(world), model.charts(world), model.uv(world), model.color(world))
        yield path.stem, digest(b"".join(each.tobytes() for each in answers))
        yield f"{path.stem}, packed", digest(pack(model.document))
        mesh = model.to_mesh(32)
        yield f"{path.stem}, mesh", digest(glb_bytes(mesh)) if len(mesh.faces) else "no faces"


def digest(data: bytes) -> str:
    """The first 16 hexadecimal digits: enough to tell a change."""
    return hashlib.sha256(data).hexdigest()[:16]


if __name__ == "__main__":
    sys.exit(main())
