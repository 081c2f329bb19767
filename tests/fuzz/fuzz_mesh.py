"""Fuzzing of the content of MESH by mutations: sections of small parts with bytes changed.

    python -m tests.fuzz.fuzz_mesh -runs=300000 [-seed=0]

A coverage-guided fuzzer learns little here: each byte of an adaptive code changes what all after it
mean. Fails when anything but `FormatError` escapes, when a content takes more than its time, or its
memory, and when what was read cannot be written and read again.
"""

from __future__ import annotations

import random
import sys
import time
import tracemalloc
from dataclasses import replace

import numpy as np

from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import Placement
from nispcodec.format.constants import MESH_FACES_PER_BYTE
from nispcodec.format.mesh import decode, encode
from tests.format.mesh.parts import box, grid

SECONDS, SECONDS_A_FACE = 1.0, 1e-3
BYTES_A_FACE = 4000
CHECKED = 50
"""One in so many is measured for memory, which takes ten times as long, and written again."""


def seeds() -> list[bytes]:
    """Contents that are valid, short ones first."""
    parts = (box(), grid(2), grid(3, turned=True))
    copies = Placement(), Placement(offset=(0.5, 0.0, 0.0), materials=np.zeros(1, np.int32))
    several = replace(box(), placements=copies * 9)
    contents = [*((part,) for part in parts), parts, (grid(9),), (several,)]
    return [encode(content) for content in contents]


def mutated(generator: random.Random, data: bytes) -> bytes:
    """A few bytes changed, left out or put in; now and then all of them at random."""
    made = bytearray(data)
    for _ in range(generator.choice((1, 1, 2, 4))):
        place = generator.randint(0, len(made))
        kind = generator.randrange(5)
        if kind == 0:
            made[place : place + 1] = b""
        elif kind == 1:
            made[place:place] = generator.randbytes(generator.randint(1, 4))
        elif kind == 2 and place < len(made):
            made[place] ^= 1 << generator.randrange(8)
        elif kind == 3:
            made[place : place + 1] = generator.choice((b"\0", b"\xff", generator.randbytes(1)))
        else:
            made[place:] = generator.randbytes(generator.randint(0, 40))
    return bytes(made)


def run(data: bytes, thorough: bool) -> bool:
    """Whether a content is read; raises RuntimeError where it takes too much."""
    faces = MESH_FACES_PER_BYTE * len(data)
    if thorough:
        tracemalloc.start()
    started = time.process_time()
    try:
        found = decode(data)
    except FormatError:
        found = None
    taken = time.process_time() - started
    if taken > (SECONDS + SECONDS_A_FACE * faces) * (10 if thorough else 1):
        raise RuntimeError(f"reading took {taken:.1f} s for {len(data)} bytes: {data.hex()}")
    if thorough:
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        if peak > 2**20 + BYTES_A_FACE * faces:
            raise RuntimeError(f"reading took {peak} bytes for {len(data)}: {data.hex()}")
        if found is not None:
            assert len(decode(encode(found))) == len(found), data.hex()
    return found is not None


def main(arguments: list[str]) -> None:
    """As many runs as asked for; prints how many were read."""
    options = dict(argument.lstrip("-").split("=") for argument in arguments[1:])
    generator = random.Random(int(options.get("seed", 0)))
    corpus, read, runs = seeds(), 0, int(options.get("runs", 1000))
    for turn in range(runs):
        data = mutated(generator, generator.choice(corpus))
        if run(data, turn % CHECKED == 0):
            read += 1
            if len(data) < 200 and len(corpus) < 2000:
                corpus.append(data)
    sys.stdout.write(f"{runs} runs, {read} read, {runs - read} refused\n")


if __name__ == "__main__":
    main(sys.argv)
