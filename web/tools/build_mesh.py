"""Builds assembly/ into decoder/mesh/module.js: AssemblyScript, then Zstandard (npm run kernel).

With --check it only compares what is there.
"""

from __future__ import annotations

import subprocess
import sys
from base64 import b64decode, b64encode
from pathlib import Path
from re import search
from tempfile import TemporaryDirectory

import zstandard

WEB = Path(__file__).parent.parent
TARGET = WEB / "decoder" / "mesh" / "module.js"
COMPILER = WEB / "node_modules" / "assemblyscript" / "bin" / "asc.js"
# What the interpreter does not know is left out.
OPTIONS = (
    *("-O3", "--converge", "--noAssert", "--runtime", "stub", "--use", "abort="),
    *("--disable", "sign-extension", "--disable", "nontrapping-f2i"),
)
HIGHEST = 22


def main() -> None:
    """Writes the module, or says that another is there."""
    module = compiled()
    if "--check" not in sys.argv:
        TARGET.write_text(written(module), encoding="utf-8")
    elif packed() != module:
        sys.exit("module.js: expected what assembly/ compiles to, found another: npm run kernel")


def compiled() -> bytes:
    with TemporaryDirectory() as folder:
        path = Path(folder, "module.wasm")
        command = ["node", str(COMPILER), "assembly/index.ts", *OPTIONS, "-o", str(path)]
        subprocess.run(command, check=True, cwd=WEB)
        return path.read_bytes()


def written(module: bytes) -> str:
    """Every unpacker knows the frame: its content's size and nothing else is in the header."""
    frame = zstandard.ZstdCompressor(HIGHEST).compress(module)
    return (
        "/** assembly/, compiled and packed: `npm run kernel` writes this file. */\n"
        f"export const MODULE_BYTES = {len(module)};\n"
        f'export const MODULE =\n  "{b64encode(frame).decode()}";\n'
    )


def packed() -> bytes:
    """The module that is there."""
    found = search(r'"([^"]+)"', TARGET.read_text(encoding="utf-8"))
    assert found is not None
    return zstandard.ZstdDecompressor().decompress(b64decode(found[1]))


if __name__ == "__main__":
    main()
