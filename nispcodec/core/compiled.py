"""Libraries in C++ that belong to the package: the best that was built and that the processor runs.

A folder has the same source compiled for several instruction sets, as `_kernel_NAME.so`; setup.py
builds them where there is a compiler. Nothing may depend on them: what they do is done without
them too, slower.
"""

from __future__ import annotations

import ctypes
import platform
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from nispcodec.core.errors import NispError

LEVELS = ("v2", "v3", "v4")
"""Of x86-64, each with the instructions of those before; the first is on every processor now."""
OTHER = "neon"
"""On arm64 there is but one."""


class KernelError(NispError):
    """A compiled library cannot be used; says why."""


@dataclass(frozen=True)
class CompiledKernel:
    """The libraries of one folder.

    signatures  of each function its result and its arguments, as ctypes has them. `nisp_version`
                and `nisp_best_level`, without arguments, are in every library
    interface   the version of the functions that Python calls
    """

    folder: Path
    interface: int
    signatures: tuple[tuple[str, Any, tuple[Any, ...]], ...]

    def best(self) -> ctypes.CDLL:
        """The functions for the best instruction set.

        Raises KernelError where there is none, or none that loads.
        """
        return _best(self)

    def available(self) -> tuple[str, ...]:
        """The instruction sets that the processor has and that were built, the best first."""
        return tuple(isa for isa, _ in _loading(self, []))

    def load(self, isa: str) -> ctypes.CDLL:
        """The functions for one instruction set, "v2", "v3", "v4" or "neon".

        Raises KernelError where it was not built, does not load, or is not of this version.
        """
        return _load(self, isa)

    def path(self, isa: str) -> Path:
        """Where that library is, if it is there."""
        return self.folder / f"_kernel_{isa}.so"


@cache
def _best(kernel: CompiledKernel) -> ctypes.CDLL:
    failures: list[str] = []
    for _, functions in _loading(kernel, failures):
        return functions
    raise KernelError("; ".join(failures))


def _loading(kernel: CompiledKernel, failures: list[str]) -> Iterator[tuple[str, ctypes.CDLL]]:
    """Those that load, the best first; adds to `failures` why others do not."""
    for isa in _candidates(kernel, failures):
        try:
            yield isa, _load(kernel, isa)
        except KernelError as why:
            failures.append(str(why))


def _candidates(kernel: CompiledKernel, failures: list[str]) -> list[str]:
    """What the processor runs, the best first; the simplest library tells."""
    if platform.machine() in ("arm64", "aarch64"):
        return [OTHER]
    try:
        level = int(_load(kernel, LEVELS[0]).nisp_best_level())
    except KernelError as why:
        failures.append(str(why))
        return []
    if not level:
        failures.append("the processor lacks SSE 4.2")
    return [isa for isa in reversed(LEVELS) if int(isa[1:]) <= level]


@cache
def _load(kernel: CompiledKernel, isa: str) -> ctypes.CDLL:
    path = kernel.path(isa)
    if not path.exists():
        raise KernelError(f"{path.name} was not built (no C++ compiler when this was installed?)")
    try:
        functions = ctypes.CDLL(str(path))
        version = functions.nisp_version()
    except (OSError, AttributeError) as why:
        raise KernelError(f"{path.name} does not load: {why}") from why
    if version != kernel.interface:
        expected = f"expected version {kernel.interface}, found {version}"
        raise KernelError(f"{path.name}: {expected}; install or build again")
    for name, result, arguments in kernel.signatures:
        function: Any = getattr(functions, name)
        function.restype, function.argtypes = result, list(arguments)
    return functions
