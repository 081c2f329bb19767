"""What threads of a pool do, without Python between: `threads.cpp`, built here.

`make sanitize` builds it with the sanitizer of threads.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import nispcodec.train.backend.native as native

KERNEL = Path(native.__file__).parent / "kernel"
PROGRAM = Path(__file__).with_name("threads.cpp")


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("g++") is None, reason="there is no g++ to build it")
@pytest.mark.skipif(sys.platform != "linux", reason="it tells the GNU linker what to wrap")
def test_no_step_asks_for_memory(tmp_path: Path) -> None:
    """A thread of a pool that found none would end the process."""
    built = tmp_path / "threads"
    options = ["-std=c++17", "-O1", "-pthread", "-DNISP_VECTOR_LENGTH=4", f"-I{KERNEL}"]
    wrapped = ["-Wno-psabi", "-Wl,--wrap=aligned_alloc"]
    subprocess.run(["g++", *options, *wrapped, str(PROGRAM), "-o", str(built)], check=True)
    done = subprocess.run([str(built)], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
