"""gltfpack with `-cc` and `-cz`, at several bit depths.

Found on the PATH, or in `node_modules` of the working folder: `npm install gltfpack@1.3.0`.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, Unavailable, glb
from nispcodec.core.asset import TexturedMesh

VERSION = "1.3"
LOCAL = Path("node_modules/.bin/gltfpack")
BITS = ((14, 12), (12, 12), (11, 11), (10, 10), (9, 9))
# Keep materials by name, and no textures but the one in the file.
KEPT = ("-km",)
# The newer of the two names, whose vertices take fewer bytes.
EXTENSION = ("-ce", "khr")


def settings(source: Source, quick: bool) -> list[Setting]:
    """Compression, bits of positions and of UVs. Raises Unavailable without the program."""
    program()
    bits = BITS[1::2] if quick else BITS
    return [{"compression": c, "vp": vp, "vt": vt} for c in ("cc", "cz") for vp, vt in bits]


def program() -> str:
    """The command to run."""
    found = shutil.which("gltfpack") or (str(LOCAL) if LOCAL.exists() else None)
    if found is None:
        raise Unavailable(f"gltfpack is not installed: npm install gltfpack@{VERSION}.0")
    told = subprocess.run([found, "-v"], capture_output=True, text=True).stdout.strip()
    if told != f"gltfpack {VERSION}":
        raise Unavailable(f"{found}: expected gltfpack {VERSION}, found {told or 'another'}")
    return found


def encode(source: Source, setting: Setting) -> bytes:
    """A GLB with KHR_meshopt_compression."""
    return packed(source, setting)


def packed(source: Source, setting: Setting, *more: str) -> bytes:
    """The same with further options."""
    options = [f"-{setting['compression']}", "-vp", str(setting["vp"]), "-vt", str(setting["vt"])]
    return _converted(glb.encode(source, {}), [*options, *EXTENSION, *more])


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
