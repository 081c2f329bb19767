"""Coverage-guided fuzzing of the parser: `make fuzz`, or with any options of libFuzzer

    python -m tests.fuzz.fuzz_unpack -runs=2000000 CORPUS

Fails when anything but `FormatError` escapes, when one file takes longer than a second of processor
time, and when the process grows by more than parsing may take. The corpus is filled with the
conformance files.
"""

from __future__ import annotations

import resource
import sys
import time
from contextlib import suppress
from pathlib import Path

import atheris

with atheris.instrument_imports(include=["nispcodec.format", "nispcodec.document"]):
    from nispcodec.errors import FormatError
    from nispcodec.format import unpack
    from nispcodec.format.constants import MAX_MEMORY

from tests.fuzz.repair import repair

SEEDS = Path(__file__).parents[1] / "conformance"
SECONDS = 1.0


def main(arguments: list[str]) -> None:
    """Fuzz until libFuzzer's options say stop."""
    folders = [Path(argument) for argument in arguments[1:] if not argument.startswith("-")]
    if folders:
        _fill(folders[0])
    baseline = _memory()
    slowest = 0.0

    def one(data: bytes) -> None:
        nonlocal slowest
        for candidate in {data, repair(data)}:
            started = time.process_time()
            with suppress(FormatError):
                unpack(candidate)
            slowest = max(slowest, time.process_time() - started)
        _check(slowest, baseline, len(data))

    atheris.Setup(arguments, one)
    atheris.Fuzz()


def _check(slowest: float, baseline: int, size: int) -> None:
    if slowest > SECONDS:
        raise RuntimeError(f"parsing took {slowest:.1f} s, expected at most {SECONDS} s")
    grown = _memory() - baseline
    if grown > MAX_MEMORY + 2 * size:
        raise RuntimeError(f"memory grew by {grown} bytes, expected at most {MAX_MEMORY}")


def _memory() -> int:
    """The most memory that the process has had, in bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def _fill(corpus: Path) -> None:
    corpus.mkdir(parents=True, exist_ok=True)
    for path in SEEDS.rglob("*.nisp"):
        (corpus / f"{path.parent.name}-{path.name}").write_bytes(path.read_bytes())


if __name__ == "__main__":
    main(sys.argv)
