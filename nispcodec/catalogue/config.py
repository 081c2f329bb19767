"""How a batch is run: what a user chooses, and what is derived from the machine."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from nispcodec.core.cores import cores
from nispcodec.core.errors import NispError

ENGINES = ("processes", "ray")


@dataclass(frozen=True)
class BatchConfig:
    """How to run a batch; nothing here changes a byte of an output.

    jobs       assets at work at a time, one core each; 0: as many as cores and memory are good for
    timeout    seconds that one asset may take, 0 for any number
    memory     bytes that the process of one asset may allocate; 0: its share of the machine's
    retries    how often an asset is begun again after a failure that may not come again: a crash,
               a storage that does not answer
    thumbnail  pixels of the pictures of original and decode, 0 for none
    compare    whether to measure each decode, too, as `nisp compare` does
    engine     "processes" of this machine, or the tasks of "ray"
    address    of the Ray cluster; "" begins one on this machine

    need       bytes of memory that an asset is planned with: encodes of the benchmark take up to
               0.5e9
    spare      share of the machine's memory that is left to everything else

    Raises NispError for a number or an engine that makes no sense.
    """

    jobs: int = 0
    timeout: float = 0
    memory: int = 0
    retries: int = 1
    thumbnail: int = 96
    compare: bool = False
    engine: str = "processes"
    address: str = ""
    need: int = 1_500_000_000
    spare: float = 0.1

    def __post_init__(self) -> None:
        if self.engine not in ENGINES:
            raise NispError(f"engine: expected one of {', '.join(ENGINES)}, found {self.engine!r}")
        for name in ("jobs", "timeout", "memory", "retries", "thumbnail"):
            if not getattr(self, name) >= 0:
                raise NispError(f"{name}: expected 0 or more, found {getattr(self, name)}")

    def jobs_here(self) -> int:
        """Assets at work at a time on this machine."""
        able = max(1, int(machine_memory() * (1 - self.spare)) // (self.memory or self.need))
        return self.jobs or min(cores(), able)

    def memory_here(self) -> int:
        """Bytes that one of them may allocate."""
        return self.memory or int(machine_memory() * (1 - self.spare)) // self.jobs_here()


def machine_memory() -> int:
    """Bytes of memory of this machine, or of the container that this process is in."""
    found = [os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")]
    for limit in ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"):
        text = Path(limit).read_text().strip() if Path(limit).is_file() else ""
        found += [int(text)] if text.isdigit() else []
    return min(found)
