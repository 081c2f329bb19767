"""A network under training in the kernel."""

from __future__ import annotations

import ctypes
import os
import threading
import weakref
from collections.abc import Callable

import numpy as np

from nispcodec.core.arrays import Float32Array, Int32Array, Int64Array, IntArray
from nispcodec.core.network import NetworkSpec
from nispcodec.core.sample_set import SampleSet
from nispcodec.train.backend.native.library import (
    NativeError,
    SamplePointers,
    Topology,
    checked,
    library,
    pointer,
)
from nispcodec.train.backend.native.settings import Settings
from nispcodec.train.soap_bases import bases

LOSSES = ("sdf", "chart", "uv")
"""In the order of the kernel's numbers for them."""


def why_not(spec: NetworkSpec, loss: str, optimizer: str) -> str:
    """Why the kernel cannot train such a network, in words; "" where it can.

    loss      the name of an objective of `nispcodec.train.objectives.OBJECTIVES`
    optimizer "muon" or "adam"
    """
    conditioned = spec.conditioning != "none"
    reasons = {
        f"the {spec.encoding} encoding": spec.encoding != "identity",
        f"{spec.activation} activations": spec.activation != "sine",
        f"a {spec.output} output": spec.output != "identity",
        f"{spec.conditioning} conditioning": spec.conditioning == "scalar",
        f"the optimizer {optimizer}": optimizer != "muon",
        f"the loss {loss}": loss not in LOSSES,
        f"charts in the loss {loss}": conditioned and loss != "uv",
        f"{spec.outputs} outputs of the loss {loss}": not _fits(loss, spec.outputs),
    }
    missing = [what for what, is_so in reasons.items() if is_so]
    return f"the native backend has not: {', '.join(missing)}" if missing else ""


def _fits(loss: str, outputs: int) -> bool:
    return outputs == {"sdf": 1, "uv": 2}.get(loss, outputs)


class NativeTrainer:
    """Trains by the kernel: the same steps as the torch backend's.

    Weights are one vector (n,) float32 in the order of `spec.shapes`; sine layers hold w0 W and
    w0 b. Every byte is the same whatever the number of `threads`, which may be changed between
    steps. What `kept` has 0 for stays 0.
    """

    def __init__(
        self,
        spec: NetworkSpec,
        samples: SampleSet,
        loss: str,
        weights: Float32Array,
        kept: Float32Array | None,
        settings: Settings,
        threads: int = 1,
        isa: str | None = None,
    ) -> None:
        """Begin with `weights`, which are copied. `isa` is for tests: see `library`.

        Raises NativeError where there is no native backend, or none for such a network; ValueError
        for arrays of another size or kind, or charts that the network has not.
        """
        if why := why_not(spec, loss, "muon"):
            raise NativeError(why)
        self.spec, self._lock = spec, threading.Lock()
        self._samples, self._kept = _prepared(samples), kept
        self._check(spec, loss, kept)
        self._functions = library(isa).functions
        self._trainer = self._made(loss, settings)
        # A forked child has none of the threads that the end would wait for.
        told = (self._functions.nisp_trainer_free, self._trainer, os.getpid())
        # Not when Python ends: a fit's thread may still be computing with it.
        weakref.finalize(self, _free, *told).atexit = False
        self.restart(weights)
        self.threads = threads

    @property
    def weights(self) -> Float32Array:
        """(n,) as they are now; a copy."""
        return self._weights.copy()

    @property
    def mean(self) -> Float32Array:
        """(n,) their running mean; a copy."""
        return self._mean.copy()

    @property
    def threads(self) -> int:
        """How many threads compute."""
        return self._threads

    @threads.setter
    def threads(self, threads: int) -> None:
        """1 to 256. Raises ValueError for others, NativeError where there are not so many."""
        if not 1 <= threads <= 256:
            raise ValueError(f"threads: expected 1 to 256, found {threads}")
        with self._lock:
            if not self._functions.nisp_set_threads(self._trainer, threads):
                raise NativeError(f"{threads} threads: out of memory, or not allowed")
        self._threads = threads

    def restart(self, weights: Float32Array) -> None:
        """Go on from `weights`, which the mean is then, too; the optimizer forgets everything."""
        checked("weights", weights, np.float32, self.spec.weight_count)
        with self._lock:
            self._weights = weights.copy() if self._kept is None else weights * self._kept
            self._mean = self._weights.copy()
            self._functions.nisp_restart(self._trainer)
            self._fresh = True

    def steps(self, rows: Int32Array, rates: Float32Array) -> Float32Array:
        """Take k steps with the samples `rows` (k, batch) at the rates (k,); their losses (k,).

        Raises ValueError for arrays of another kind and rows that no sample has, NativeError
        without memory.
        """
        checked("rows", rows, np.int32, None, None)
        checked("rates", rates, np.float32, len(rows))
        self._check_rows(rows)
        losses = np.empty(len(rows), dtype=np.float32)
        with self._lock:
            done = self._some_steps(rows, rates, losses)
            while done < len(rows):
                done += self._some_steps(rows[done:], rates[done:], losses[done:])
        return losses

    def gradient(self, rows: Int32Array) -> tuple[float, Float32Array]:
        """The loss of the samples `rows` (batch,) and its gradient (n,), not clipped.

        Raises ValueError for rows that no sample has.
        """
        checked("rows", rows, np.int32, None)
        self._check_rows(rows)
        found = np.empty_like(self._weights)
        told = (pointer(self._weights), pointer(rows), len(rows), pointer(found))
        with self._lock:
            loss = float(self._functions.nisp_gradient(self._trainer, *told))
        return loss, found

    def outputs(
        self, weights: Float32Array, points: Float32Array, charts: IntArray | None = None
    ) -> Float32Array:
        """The network's answers (n, outputs) with `weights` at points (n, 3) of charts (n,).

        Raises ValueError for arrays of another size or kind, or charts that it has not.
        """
        charts = self._checked_charts(weights, points, charts)
        found = np.empty((len(points), self.spec.outputs), dtype=np.float32)
        told = (pointer(weights), pointer(points), pointer(charts), len(points), pointer(found))
        with self._lock:
            self._functions.nisp_outputs(self._trainer, *told)
        return found

    def slopes(
        self,
        weights: Float32Array,
        points: Float32Array,
        charts: IntArray | None,
        directions: Float32Array,
        places: Int64Array | None = None,
    ) -> Float32Array:
        """How each point's outputs, times its direction (n, outputs), rise with the weights.

        (n, weights), or (n, m) with the weights at `places` (m,) alone. Raises ValueError for
        arrays of another size or kind, charts that it has not, or places outside.
        """
        charts = self._checked_charts(weights, points, charts)
        checked("directions", directions, np.float32, len(points), self.spec.outputs)
        if places is not None:
            checked("places", places, np.int64, None)
            _check_range("places", places, self.spec.weight_count)
        count = self.spec.weight_count if places is None else len(places)
        found = np.empty((len(points), count), dtype=np.float32)
        told = [pointer(each) for each in (weights, points, charts, directions)]
        asked = (len(points), pointer(places), count, pointer(found))
        with self._lock:
            self._functions.nisp_slopes(self._trainer, *told, *asked)
        return found

    def _some_steps(self, rows: Int32Array, rates: Float32Array, losses: Float32Array) -> int:
        """As many steps as the kernel takes: it stops after a first one."""
        told = (pointer(self._weights), pointer(self._mean), pointer(rows), *rows.shape)
        results = (pointer(rates), pointer(losses))
        done = int(self._functions.nisp_steps(self._trainer, *told, *results))
        if done < 0:
            raise NativeError("a training step: out of memory")
        if self._fresh and len(rows):
            self._begin_soap()
        return done

    def _begin_soap(self) -> None:
        """Give each SOAP the bases of its first gradient; numpy has the eigenvectors."""
        index = 0
        while (gradient := self._soap_gradient(index)) is not None:
            # A gradient that is no number has no bases; the loop sees such a fit by its error.
            sides = bases(np.nan_to_num(gradient, nan=0.0, posinf=0.0, neginf=0.0))
            left, right = (np.ascontiguousarray(side, np.float32) for side in sides)
            self._functions.nisp_soap_begin(self._trainer, index, pointer(left), pointer(right))
            index += 1
        self._functions.nisp_resume(self._trainer)
        self._fresh = False

    def _soap_gradient(self, index: int) -> Float32Array | None:
        rows, columns = ctypes.c_int32(), ctypes.c_int32()
        told = (self._trainer, index, ctypes.byref(rows), ctypes.byref(columns))
        if not self._functions.nisp_soap_gradient(*told, None):
            return None
        gradient = np.empty((rows.value, columns.value), dtype=np.float32)
        self._functions.nisp_soap_gradient(*told, pointer(gradient))
        return gradient

    def _made(self, loss: str, settings: Settings) -> int:
        """The address of the kernel's trainer."""
        spec, samples = self.spec, self._samples
        widths = np.asarray(spec.hidden, dtype=np.int32)
        affine = spec.conditioning == "chart_affine"
        sizes = (spec.outputs, spec.charts, spec.embedding, affine, LOSSES.index(loss))
        topology = Topology(spec.mirror, len(widths), pointer(widths), *sizes)
        arrays = (samples.points, samples.sdf, samples.chart, samples.uv)
        pointers = SamplePointers(*(pointer(array) for array in arrays))
        structs = (topology, settings.numbers(spec.w0), pointers)
        addresses = [ctypes.addressof(struct) for struct in structs]
        trainer = self._functions.nisp_trainer_new(*addresses, pointer(self._kept))
        if not trainer:
            raise NativeError("the native trainer: out of memory")
        return int(trainer)

    def _check(self, spec: NetworkSpec, loss: str, kept: Float32Array | None) -> None:
        if kept is not None:
            checked("kept", kept, np.float32, spec.weight_count)
        charts = {"chart": spec.outputs, "uv": spec.charts}.get(loss, 0)
        if charts:
            _check_range("charts of the samples", self._samples.chart, charts)

    def _check_rows(self, rows: Int32Array) -> None:
        if not rows.shape[-1]:
            raise ValueError("rows: expected a batch of at least one sample, found none")
        _check_range("rows", rows, len(self._samples))

    def _checked_charts(
        self, weights: Float32Array, points: Float32Array, charts: IntArray | None
    ) -> Int32Array | None:
        """The charts as the kernel reads them, None where nothing depends on them."""
        checked("weights", weights, np.float32, self.spec.weight_count)
        checked("points", points, np.float32, None, 3)
        if not self.spec.charts:
            return None
        if charts is None or charts.shape != (len(points),):
            raise ValueError(f"charts: expected {len(points)}, one a point, found {charts}")
        _check_range("charts", charts, self.spec.charts)
        return np.ascontiguousarray(charts, np.int32)


def _prepared(samples: SampleSet) -> SampleSet:
    """The same as the kernel reads them. Raises ValueError for lengths that differ."""
    points, sdf, uv = (
        np.ascontiguousarray(each, np.float32) for each in (samples.points, samples.sdf, samples.uv)
    )
    chart = np.ascontiguousarray(samples.chart, np.int32)
    count = len(points)
    checked("points of the samples", points, np.float32, None, 3)
    checked("sdf of the samples", sdf, np.float32, count)
    checked("uv of the samples", uv, np.float32, count, 2)
    checked("charts of the samples", chart, np.int32, count)
    return SampleSet(points, sdf, chart, uv)


def _check_range(name: str, numbers: IntArray, count: int) -> None:
    if numbers.size and not 0 <= numbers.min() <= numbers.max() < count:
        found = f"{numbers.min()} to {numbers.max()}"
        raise ValueError(f"{name}: expected 0 to {count - 1}, found {found}")


def _free(free: Callable[[int], None], trainer: int, process: int) -> None:
    if os.getpid() == process:
        free(trainer)
