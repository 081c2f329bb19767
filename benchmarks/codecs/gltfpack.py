"""gltfpack with `-cc` and `-cz`, at several bit depths; its own simplifier is meshoptimizer's too.

Found on the PATH, or in `node_modules` of the working folder: `npm install gltfpack`.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, Unavailable, glb
from nispcodec.core.asset import TexturedMesh

LOCAL = Path("node_modules/.bin/gltfpack")
BITS = ((14, 12), (12, 12), (11, 11), (10, 10), (9, 9))
# Keep materials by name, and no textures but the one in the file.
KEPT = ("-km",)


def settings(source: Source, quick: bool) -> list[Setting]:
    """Compression, bits of positions and of UVs. Raises Unavailable without the program."""
    program()
    bits = BITS[1::2] if quick else BITS
    return [{"compression": c, "vp": vp, "vt": vt} for c in ("cc", "cz") for vp, vt in bits]


def program() -> str:
    """The command to run."""
    found = shutil.which("gltfpack") or (str(LOCAL) if LOCAL.exists() else None)
    if found is None:
        raise Unavailable("gltfpack is not installed: npm install gltfpack")
    return found


def encode(source: Source, setting: Setting) -> bytes:
    """A GLB with EXT_meshopt_compression."""
    options = [f"-{setting['compression']}", "-vp", str(setting["vp"]), "-vt", str(setting["vt"])]
    return _converted(glb.encode(source, {}), options)


def decode(data: bytes, source: Source) -> TexturedMesh:
    """Unpacked to a plain GLB by the program itself, then read."""
    return glb.decode(_converted(data, ["-noq"]), source)


def _converted(data: bytes, options: list[str]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        before, after = Path(folder, "in.glb"), Path(folder, "out.glb")
        before.write_bytes(data)
        command = [program(), "-i", str(before), "-o", str(after), *KEPT, *options]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"gltfpack: {done.stdout[-300:]}{done.stderr[-300:]}")
        return after.read_bytes()
