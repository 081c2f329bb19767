"""Quadric simplification whose vertices and UVs move: meshoptimizer's `simplifyWithUpdate`.

It is in the npm package alone, which is looked for in `node_modules` of the working folder:
`npm install meshoptimizer@1.3.0`.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.assets.corners import Corners
from nispcodec.core.arrays import Uint32Array

VERSION = "1.3.0"
PACKAGE = Path("node_modules/meshoptimizer")
SCRIPT = Path(__file__).with_suffix(".mjs")


def missing() -> str | None:
    """The reason why this cannot run here, if there is one."""
    if shutil.which("node") is None:
        return "node is not installed"
    try:
        found = json.loads((PACKAGE / "package.json").read_text(encoding="utf-8"))["version"]
    except FileNotFoundError:
        return f"meshoptimizer is not installed: npm install meshoptimizer@{VERSION}"
    wrong = f"expected meshoptimizer {VERSION} in {PACKAGE.parent}, found {found}"
    return None if found == VERSION else wrong


def simplified_moving(
    corners: Corners, faces: int, uv_weight: float, permissive: bool = False
) -> Corners:
    """About `faces` triangles; vertices that coincide, at seams, move together.

    uv_weight: the error of one unit of UV against the asset's extent. permissive: seams may open or
    go, where that costs little, else they stay seams. Raises ValueError when
    nothing is left: bodies smaller than the error are dropped.
    """
    low, extent = corners.positions.min(axis=0), np.ptp(corners.positions, axis=0).max()
    header = np.array([len(corners.positions), len(corners.faces)])
    places = (corners.positions - low) / extent
    parts = [header.astype("<u4"), corners.faces.astype("<u4")]
    parts += [places.astype("<f4"), corners.uvs.astype("<f4")]
    wanted = min(faces, len(corners.faces))
    options = [str(wanted), str(uv_weight), *(["Permissive"] if permissive else [])]
    data = _converted(b"".join(part.tobytes() for part in parts), options)
    count = int(np.frombuffer(data, "<u4", 1)[0])
    if count == 0:
        raise ValueError(f"expected about {faces} of {len(corners.faces)} faces, found none left")
    indices: Uint32Array = np.frombuffer(data, "<u4", 3 * count, 4)
    moved = np.frombuffer(data, "<f4", -1, 4 + 12 * count).astype(np.float64)
    positions, uvs = np.split(moved, [corners.positions.size])
    return Corners(
        positions.reshape(-1, 3) * extent + low, uvs.reshape(-1, 2), corners.materials, indices
    ).only(indices)


def _converted(data: bytes, options: list[str]) -> bytes:
    library = (PACKAGE / "meshopt_simplifier.js").resolve()
    with tempfile.TemporaryDirectory() as folder:
        before, after = Path(folder, "in"), Path(folder, "out")
        before.write_bytes(data)
        paths = [str(path) for path in (SCRIPT, library, before, after)]
        done = subprocess.run(["node", *paths, *options], capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"node {SCRIPT.name}: {done.stderr[-300:]}")
        return after.read_bytes()
