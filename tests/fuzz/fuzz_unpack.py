"""Coverage-guided fuzzing of the parser: `make fuzz`, or with any options of libFuzzer

    python -m tests.fuzz.fuzz_unpack -runs=2000000 CORPUS

Fails when anything but `FormatError` escapes, when one file takes longer than a second of processor
time and what its triangles may take, and when the process grows in it by more than parsing may
take. The corpus is filled with the conformance files. The content of MESH is not looked into for
coverage: `fuzz_mesh` says why. Atheris itself loses a kilobyte an execution (the same calls without
its instrumentation lose none), hence a high limit for libFuzzer's own check of the whole process.
"""

from __future__ import annotations

import os
import resource
import sys
import time
from contextlib import suppress
from pathlib import Path

import atheris

with atheris.instrument_imports(
    include=["nispcodec.format", "nispcodec.core.document"], exclude=["nispcodec.format.mesh"]
):
    from nispcodec.core.errors import FormatError
    from nispcodec.format import unpack
    from nispcodec.format.constants import (
        MAX_MEMORY,
        MAX_MESH_FACES,
        MESH,
        MESH_FACES_PER_BYTE,
    )

from tests.fuzz.fuzz_mesh import BYTES_A_FACE, SECONDS, SECONDS_A_FACE
from tests.fuzz.repair import repair

SEEDS = Path(__file__).parents[1] / "conformance"
PAGE = resource.getpagesize()
STATUS = os.open("/proc/self/statm", os.O_RDONLY)


def main(arguments: list[str]) -> None:
    """Fuzz until libFuzzer's options say stop."""
    folders = [Path(argument) for argument in arguments[1:] if not argument.startswith("-")]
    if folders:
        _fill(folders[0])

    def one(data: bytes) -> None:
        for candidate in {data, repair(data)}:
            _unpack(candidate)

    atheris.Setup(arguments, one)
    atheris.Fuzz()


def _unpack(data: bytes) -> None:
    peak, resident, started = _peak(), _resident(), time.process_time()
    with suppress(FormatError):
        unpack(data)
    seconds = time.process_time() - started
    faces = MESH_FACES_PER_BYTE * len(data) if MESH.encode() in data else 0
    allowed = SECONDS + SECONDS_A_FACE * faces
    if seconds > allowed:
        raise RuntimeError(f"parsing took {seconds:.1f} s, expected at most {allowed:.1f} s")
    # Only a file that sets a new peak can have gone over; the fuzzer's own memory grows too.
    grown = _peak() - resident if _peak() > peak else 0
    # A short file may hold a long MESH, packed: `fuzz_mesh` looks at its memory face by face.
    most = MAX_MEMORY + 2 * len(data) + (BYTES_A_FACE * MAX_MESH_FACES if faces else 0)
    if grown > most:
        raise RuntimeError(f"memory grew by {grown} bytes, expected at most {most}")


def _peak() -> int:
    """The most memory that the process has had, in bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def _resident() -> int:
    """The memory that the process has now, in bytes."""
    return int(os.pread(STATUS, 100, 0).split()[1]) * PAGE


def _fill(corpus: Path) -> None:
    corpus.mkdir(parents=True, exist_ok=True)
    for path in SEEDS.rglob("*.nisp"):
        (corpus / f"{path.parent.name}-{path.name}").write_bytes(path.read_bytes())


if __name__ == "__main__":
    main(sys.argv)
