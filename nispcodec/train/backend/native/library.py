"""The functions of the compiled kernel, and the structs that they take."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from nispcodec.core.arrays import AnyArray
from nispcodec.core.compiled import LEVELS, OTHER, CompiledKernel, KernelError
from nispcodec.core.errors import NispError


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


def library(isa: str | None = None) -> Library:
    """The kernel for an instruction set, "v2", "v3", "v4" or "neon"; without one for the best.

    Raises NativeError where there is none, or none that loads here.
    """
    try:
        if isa is None:
            functions = KERNEL.best()
            return Library(available()[0], functions)
        if isa not in (*LEVELS, OTHER):
            known = f"{', '.join(LEVELS)} or {OTHER}"
            raise NativeError(f"instruction set: expected {known}, found {isa}")
        if isa in LEVELS[1:] and isa not in available():
            raise NativeError(
                f"the processor has no instruction set {isa}, or its kernel is not built"
            )
        return Library(isa, KERNEL.load(isa))
    except KernelError as why:
        raise NativeError(f"no native backend: {why}") from why


def available() -> tuple[str, ...]:
    """The instruction sets that the processor has and that were built, the best first."""
    return KERNEL.available()


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


_P, _I, _L, _F, _D = (
    ctypes.c_void_p,
    ctypes.c_int32,
    ctypes.c_int64,
    ctypes.c_float,
    ctypes.c_double,
)
KERNEL = CompiledKernel(
    folder=Path(__file__).parent,
    interface=1,
    signatures=(
        ("nisp_best_level", _I, ()),
        ("nisp_vector_length", _I, ()),
        ("nisp_peak", _L, (_L,)),
        ("nisp_trainer_new", _P, (_P, _P, _P, _P)),
        ("nisp_trainer_free", None, (_P,)),
        ("nisp_set_threads", _I, (_P, _I)),
        ("nisp_restart", None, (_P,)),
        ("nisp_resume", None, (_P,)),
        ("nisp_gradient", _F, (_P, _P, _P, _I, _P)),
        ("nisp_steps", _I, (_P, _P, _P, _P, _I, _I, _P, _P)),
        ("nisp_soap_gradient", _I, (_P, _I, _P, _P, _P)),
        ("nisp_soap_begin", None, (_P, _I, _P, _P)),
        ("nisp_outputs", None, (_P, _P, _P, _P, _L, _P)),
        ("nisp_slopes", None, (_P, _P, _P, _P, _P, _L, _P, _L, _P)),
        ("nisp_grid_new", _P, (_P, _I)),
        ("nisp_grid_free", None, (_P,)),
        ("nisp_error_radii", _I, (_P, _P, _P, _D, _I, _P)),
    ),
)
"""Functions of kernel/interface.cpp; `interface` is the version of their arguments."""
