"""Where and with what a number was measured."""

from __future__ import annotations

import os
import platform
import subprocess
from importlib.metadata import version
from pathlib import Path

LIBRARIES = ("nispcodec", "numpy", "scipy", "torch", "libigl", "scikit-image", "zstandard")


def machine() -> dict[str, str | int]:
    """Processor, cores and memory."""
    cpu = [line for line in Path("/proc/cpuinfo").read_text().splitlines() if "model name" in line]
    pages = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return {
        "system": platform.platform(),
        "processor": cpu[0].split(":", 1)[1].strip() if cpu else platform.machine(),
        "cores": len(os.sched_getaffinity(0)),
        "memory_bytes": pages,
    }


def versions() -> dict[str, str]:
    """Python and the libraries that the numbers depend on."""
    return {"python": platform.python_version()} | {name: version(name) for name in LIBRARIES}


def commit(tree: Path = Path(__file__).parent) -> str:
    """The commit checked out in a tree, ours unless told, with `+changes` when files differ."""
    asked = ["git", "-C", str(tree), "describe", "--always", "--abbrev=12", "--dirty=+changes"]
    return subprocess.run(asked, capture_output=True, text=True, check=True).stdout.strip()
