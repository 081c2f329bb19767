"""Native decoders at work in a process of their own, on bytes that nobody can check beforehand.

Damaged data may crash such a decoder, let it run for long, or take all memory: the process ends
then, and the one that asked goes on. This module is both sides of it.

A message is its length in eight bytes, little-endian, and as many bytes. Each job is a message to
the process. It answers each by a message: b"+" and arrays in the format NPZ, or b"-" and a reason.
"""

from __future__ import annotations

import io
import os
import signal
import struct
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import BinaryIO

import numpy as np

from nispcodec.core.arrays import AnyArray

Arrays = dict[str, AnyArray]
Decoder = Callable[[bytes], Arrays]
"""Raises ValueError, whose text says why, for what it cannot decode."""


@dataclass(frozen=True)
class ApartConfig:
    """The limits of a decoder for one job.

    seconds           of the processor, whatever the size; real files of 1 MB take 0.1
    bytes_per_second  adds a second for each so many bytes
    memory            in bytes, besides what the started process has
    memory_per_byte   adds so many bytes for each byte of the job
    start_seconds     for the process to start, by the clock, on a machine that is busy
    """

    seconds: float = 1.5
    bytes_per_second: float = 200_000.0
    memory: int = 500_000_000
    memory_per_byte: int = 500
    start_seconds: float = 60.0


_DEFAULT = ApartConfig()


def decode_apart(
    decoder: str, jobs: Sequence[bytes], config: ApartConfig = _DEFAULT
) -> list[Arrays | str]:
    """The arrays that a decoder makes of each job, or the reason why it makes nothing of it.

    `decoder` is the name of a function, with its module: "package.module:function".
    """
    answers: list[Arrays | str] = []
    while len(answers) < len(jobs):
        answers += _answers(decoder, jobs[len(answers) :], config)
    return answers


def _answers(decoder: str, jobs: Sequence[bytes], config: ApartConfig) -> list[Arrays | str]:
    """Those of one process; the last one is a reason where the process ended early."""
    output, status = _run(decoder, jobs, config)
    answers = [_answer(message) for message in _messages(io.BytesIO(output))]
    if len(answers) < len(jobs):
        answers.append(_why(status))
    return answers


def _run(decoder: str, jobs: Sequence[bytes], config: ApartConfig) -> tuple[bytes, int | None]:
    """What the process wrote, and its exit status, None where it took too long."""
    limits = [config.seconds, config.bytes_per_second, config.memory, config.memory_per_byte]
    code = f"from {__name__} import serve; serve()"
    # Never the working folder, which may hold anything: only what this process imports from.
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    command = [sys.executable, "-P", "-c", code, decoder, *map(str, limits)]
    # Where the system cannot limit the processor's time, the clock does.
    seconds = config.start_seconds + sum(_seconds(len(job), limits) for job in jobs) * 4
    try:
        done = subprocess.run(
            command,
            input=b"".join(map(_message, jobs)),
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=environment | {"OPENBLAS_NUM_THREADS": "1"},
            timeout=seconds,
            check=False,
        )
    except subprocess.TimeoutExpired as late:
        return late.output or b"", None
    return done.stdout, done.returncode


def _why(status: int | None) -> str:
    late = (None, -getattr(signal, "SIGPROF", 0))
    return "data that take too long to decode" if status in late else "data that crash the decoder"


def _answer(message: bytes) -> Arrays | str:
    if message[:1] != b"+":
        return message[1:].decode(errors="replace")
    with np.load(io.BytesIO(message[1:]), allow_pickle=False) as arrays:
        return dict(arrays)


def _message(data: bytes) -> bytes:
    return struct.pack("<Q", len(data)) + data


def _messages(stream: BinaryIO) -> Iterator[bytes]:
    """The messages of a stream, without a last one that is cut short."""
    while len(head := stream.read(8)) == 8:
        (length,) = struct.unpack("<Q", head)
        data = stream.read(length)
        if len(data) < length:
            return
        yield data


def serve() -> None:
    """Answer the messages of standard input, within the limits that the command line names."""
    module, _, function = sys.argv[1].partition(":")
    decoder: Decoder = getattr(import_module(module), function)
    limits = [float(each) for each in sys.argv[2:]]
    output = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is no answer
    for data in _messages(sys.stdin.buffer):
        _limit(len(data), limits)
        output.write(_message(_reply(decoder, data)))
        output.flush()


def _reply(decoder: Decoder, data: bytes) -> bytes:
    try:
        file = io.BytesIO()
        np.savez(file, allow_pickle=False, **decoder(data))
        return b"+" + file.getvalue()
    except MemoryError:
        return b"-data that take too much memory to decode"
    except Exception as why:  # of a library that says nowhere what it raises
        return b"-" + str(why).encode()


def _seconds(length: int, limits: Sequence[float]) -> float:
    return limits[0] + length / limits[1]


def _limit(length: int, limits: Sequence[float]) -> None:
    """From here on for a job of this length; where the system has no such limits, none."""
    if sys.platform == "win32":
        return
    import resource

    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    signal.setitimer(signal.ITIMER_PROF, _seconds(length, limits))
    taken = Path("/proc/self/statm")
    if taken.exists():
        now = int(taken.read_text().split()[0]) * resource.getpagesize()
        most, hard = (
            now + int(limits[2] + limits[3] * length),
            resource.getrlimit(resource.RLIMIT_AS)[1],
        )
        allowed = most if hard == resource.RLIM_INFINITY else min(most, hard)
        resource.setrlimit(resource.RLIMIT_AS, (allowed, hard))
