"""Finding and loading the compiled kernel: the best instruction set that the processor has."""

from __future__ import annotations

import ctypes
import platform
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from nispcodec.core.arrays import AnyArray
from nispcodec.core.errors import NispError

LEVELS = ("v2", "v3", "v4")
"""Of x86-64, each with the instructions of those before; the first is on every processor of today.

The library of an instruction set is `_kernel_NAME.so` beside this file.
"""
OTHER = "neon"
"""On arm64 there is but one."""


class NativeError(NispError):
    """The native backend cannot be used; says why."""


class Topology(ctypes.Structure):
    """`nisp::Topology` of kernel/network.h."""

    _fields_ = (
        ("mirror", ctypes.c_int32),
        ("hidden_layers", ctypes.c_int32),
        ("widths", ctypes.c_void_p),
        ("outputs", ctypes.c_int32),
        ("charts", ctypes.c_int32),
        ("embedding", ctypes.c_int32),
        ("affine", ctypes.c_int32),
        ("loss", ctypes.c_int32),
    )


class Numbers(ctypes.Structure):
    """`nisp::Settings` of kernel/settings.h."""

    _fields_ = (
        ("near", ctypes.c_float),
        ("sign_weight", ctypes.c_float),
        ("sign_softness", ctypes.c_float),
        ("w0", ctypes.c_float),
        ("last_layer_rate", ctypes.c_float),
        ("ema_weight", ctypes.c_float),
        ("clip", ctypes.c_float),
        ("muon_size", ctypes.c_double),
        ("muon_least", ctypes.c_double),
        ("muon_most", ctypes.c_double),
        ("momentum_share", ctypes.c_double),
        ("muon_quintic", ctypes.c_float * 3),
        ("muon_rounds", ctypes.c_int32),
        ("soap_beta", ctypes.c_double),
        ("soap_epsilon", ctypes.c_double),
        ("soap_refresh_every", ctypes.c_int32),
    )


class SamplePointers(ctypes.Structure):
    """`nisp::Samples` of kernel/tile.h."""

    _fields_ = tuple((name, ctypes.c_void_p) for name in ("points", "sdf", "chart", "uv"))


@dataclass(frozen=True)
class Library:
    """The functions of kernel/interface.cpp, compiled for the instruction set `isa`."""

    isa: str
    functions: ctypes.CDLL

    interface = 1
    """The version of the functions' arguments that this package calls."""


def library(isa: str | None = None) -> Library:
    """The kernel for an instruction set, "v2", "v3", "v4" or "neon"; without one for the best.

    Raises NativeError where there is none, or none that loads here.
    """
    if isa is None:
        return _best()
    if isa not in (*LEVELS, OTHER):
        raise NativeError(f"instruction set: expected {', '.join(LEVELS)} or {OTHER}, found {isa}")
    if isa in LEVELS[1:] and isa not in available():
        raise NativeError(f"the processor has no instruction set {isa}, or its kernel is not built")
    return _load(isa)


@cache
def available() -> tuple[str, ...]:
    """The instruction sets that the processor has and that were built, the best first."""
    return tuple(found.isa for found in _loading([]))


def pointer(array: AnyArray | None) -> ctypes.c_void_p:
    """Where an array's numbers are; null without one. Whoever calls checks it, and keeps it."""
    return ctypes.c_void_p(None if array is None else array.ctypes.data)


def checked(name: str, array: AnyArray, kind: type[np.generic], *shape: int | None) -> None:
    """Raise ValueError unless an array is in order, of that kind and shape; None: any length."""
    fits = len(array.shape) == len(shape) and all(
        wanted in (None, found) for wanted, found in zip(shape, array.shape, strict=False)
    )
    if array.dtype != kind or not fits or not array.flags.c_contiguous:
        wanted = ", ".join("any" if length is None else str(length) for length in shape)
        expected = f"expected {kind.__name__} ({wanted}) in C order"
        raise ValueError(f"{name}: {expected}, found {array.dtype} {array.shape}")


@cache
def _best() -> Library:
    failures: list[str] = []
    for found in _loading(failures):
        return found
    raise NativeError(f"no native backend: {'; '.join(failures)}")


def _loading(failures: list[str]) -> Iterator[Library]:
    """Those that load, the best first; adds to `failures` why others do not."""
    for isa in _candidates(failures):
        try:
            yield _load(isa)
        except NativeError as why:
            failures.append(str(why))


def _candidates(failures: list[str]) -> list[str]:
    """What the processor runs, the best first; the simplest kernel tells."""
    if platform.machine() in ("arm64", "aarch64"):
        return [OTHER]
    try:
        level = int(_load(LEVELS[0]).functions.nisp_best_level())
    except NativeError as why:
        failures.append(str(why))
        return []
    if not level:
        failures.append("the processor lacks SSE 4.2")
    return [isa for isa in reversed(LEVELS) if int(isa[1:]) <= level]


def _path(isa: str) -> Path:
    return Path(__file__).parent / f"_kernel_{isa}.so"


@cache
def _load(isa: str) -> Library:
    path = _path(isa)
    if not path.exists():
        raise NativeError(f"{path.name} was not built (no C++ compiler when this was installed?)")
    try:
        functions = ctypes.CDLL(str(path))
        version = functions.nisp_version()
    except (OSError, AttributeError) as why:
        raise NativeError(f"{path.name} does not load: {why}") from why
    if version != Library.interface:
        expected = f"expected version {Library.interface}, found {version}"
        raise NativeError(f"{path.name}: {expected}; install or build again")
    return Library(isa, _declared(functions))


def _declared(functions: ctypes.CDLL) -> ctypes.CDLL:
    for name, (result, arguments) in _SIGNATURES.items():
        function: Any = getattr(functions, name)
        function.restype, function.argtypes = result, arguments
    return functions


_P, _I, _L, _F, _D = (
    ctypes.c_void_p,
    ctypes.c_int32,
    ctypes.c_int64,
    ctypes.c_float,
    ctypes.c_double,
)
_SIGNATURES: dict[str, tuple[Any, list[Any]]] = {
    "nisp_best_level": (_I, []),
    "nisp_vector_length": (_I, []),
    "nisp_peak": (_L, [_L]),
    "nisp_trainer_new": (_P, [_P, _P, _P, _P]),
    "nisp_trainer_free": (None, [_P]),
    "nisp_set_threads": (_I, [_P, _I]),
    "nisp_restart": (None, [_P]),
    "nisp_resume": (None, [_P]),
    "nisp_gradient": (_F, [_P, _P, _P, _I, _P]),
    "nisp_steps": (_I, [_P, _P, _P, _P, _I, _I, _P, _P]),
    "nisp_soap_gradient": (_I, [_P, _I, _P, _P, _P]),
    "nisp_soap_begin": (None, [_P, _I, _P, _P]),
    "nisp_outputs": (None, [_P, _P, _P, _P, _L, _P]),
    "nisp_slopes": (None, [_P, _P, _P, _P, _P, _L, _P, _L, _P]),
    "nisp_grid_new": (_P, [_P, _I]),
    "nisp_grid_free": (None, [_P]),
    "nisp_error_radii": (_I, [_P, _P, _P, _D, _I, _P]),
}
