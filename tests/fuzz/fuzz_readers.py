"""Mutated mesh files for the readers: `python -m tests.fuzz.fuzz_readers 10000 1` (how many, seed).

Fails when anything but `NispError` escapes, when one file takes longer than two seconds of
processor time, and when the process grows by more than 20 times the file and 200 MB.
"""

from __future__ import annotations

import random
import resource
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import NispError
from nispcodec.io.folder import Folder
from nispcodec.io.load import READERS
from nispcodec.io.save import write_mesh
from tests.io.test_gltf import textured
from tests.io.test_gltf_meshopt import square
from tests.metrics.shapes import sphere

SECONDS = 2.0
GROWTH, BESIDES = 20, 200_000_000
# What numbers in files go wrong by.
NUMBERS = (
    "-1",
    "0",
    "1",
    "nan",
    "inf",
    "1e400",
    "4294967295",
    "-9223372036854775809",
    "1e-300",
    "",
)
BYTES = (0, 1, 127, 128, 255, 10, 32, 35, 47)
OFF = b"STOFF\n3 1 0\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"
STL = b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
STRIPS = b"""ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
property uchar red
element tristrips 1
property list int int vertex_indices
end_header
0 0 0 9
1 0 0 9
0 1 0 9
1 1 0 9
5 0 1 2 -1 3
"""


def seeds(folder: Path) -> list[tuple[str, bytes]]:
    """Suffixes and files to begin with; those that other files name are in the folder."""
    mesh = sphere(subdivisions=0)
    found = [(".off", OFF), (".stl", STL + b"endloop\nendfacet\nendsolid\n"), (".ply", STRIPS)]
    for suffix in (".obj", ".glb", ".ply", ".stl"):
        write_mesh(mesh, folder / f"a{suffix}")
        found.append((suffix, (folder / f"a{suffix}").read_bytes()))
    documents = (textured(), square(), square(mode="INDICES", size=2, filter="EXPONENTIAL"))
    found += [(".glb", each.glb()) for each in documents]
    return [*found, (".gltf", textured().text()), (".mtl", (folder / "a.mtl").read_bytes())]


def mutated(data: bytes, chance: random.Random) -> bytes:
    """The bytes with one to four changes: bytes, numbers, pieces left out, doubled or moved."""
    changed = bytearray(data)
    for _ in range(chance.choice((1, 1, 2, 4))):
        if changed:
            chance.choice(CHANGES)(changed, chance)
    return bytes(changed)


def _byte(data: bytearray, chance: random.Random) -> None:
    data[chance.randrange(len(data))] = chance.choice((*BYTES, chance.randrange(256)))


def _bit(data: bytearray, chance: random.Random) -> None:
    data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)


def _number(data: bytearray, chance: random.Random) -> None:
    """Another number in the place of digits."""
    start = chance.randrange(len(data))
    while start < len(data) and not 48 <= data[start] <= 57:
        start += 1
    end = start
    while end < len(data) and 48 <= data[end] <= 57:
        end += 1
    data[start:end] = chance.choice(NUMBERS).encode()


def _without(data: bytearray, chance: random.Random) -> None:
    start = chance.randrange(len(data))
    del data[start : start + chance.choice((1, 4, 30, 10_000))]


def _doubled(data: bytearray, chance: random.Random) -> None:
    start, place = chance.randrange(len(data)), chance.randrange(len(data))
    data[place:place] = data[start : start + chance.choice((1, 8, 60))]


CHANGES: tuple[Callable[[bytearray, random.Random], None], ...] = (
    _byte,
    _bit,
    _number,
    _without,
    _doubled,
)


def one(suffix: str, data: bytes, folder: Path) -> str:
    """Read a file: "read" or "refused". Raises RuntimeError where that takes too much."""
    peak, started = _peak(), time.process_time()
    if suffix == ".mtl":
        (folder / "a.mtl").write_bytes(data)
        suffix, data = ".obj", (folder / "a.obj").read_bytes()
    found: TexturedMesh | None = None
    with suppress(NispError):
        found = READERS[suffix](data, f"a{suffix}", Folder(folder))
    if time.process_time() - started > SECONDS:
        raise RuntimeError(f"took {time.process_time() - started:.1f} s")
    if _peak() - peak > GROWTH * len(data) + BESIDES:
        raise RuntimeError(f"took {_peak() - peak} bytes")
    return "refused" if found is None else "read"


def _peak() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def main(arguments: list[str]) -> None:
    """Read so many files, and say what came; what fails is kept beside, and raised."""
    count, chance = int(arguments[1]), random.Random(int(arguments[2]))
    came: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name, np.errstate(all="ignore"):
        folder = Path(name)
        start = seeds(folder)
        for _ in range(count):
            suffix, data = chance.choice(start)
            data = mutated(data, chance)
            try:
                came[f"{suffix} {one(suffix, data, folder)}"] += 1
            except Exception:
                Path(f"failed{suffix}").write_bytes(data)
                raise
    for kind in sorted(came):
        print(f"{kind}: {came[kind]:,}")  # noqa: T201


if __name__ == "__main__":
    main(sys.argv)
