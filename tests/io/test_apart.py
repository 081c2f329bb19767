from __future__ import annotations

import ctypes
import os
import sys

import numpy as np
import pytest

from nispcodec.io.apart import ApartConfig, Arrays, decode_apart

HERE = "tests.io.test_apart"


def decoder(data: bytes) -> Arrays:
    """Does what the first byte says."""
    kind = data[:1]
    if kind == b"x":
        ctypes.string_at(0)
    if kind == b"l":
        while True:
            pass
    if kind == b"m":
        return {"large": np.ones(10**9)}
    if kind == b"r":
        raise ValueError("no such thing")
    if kind == b"p":
        os.write(1, b"a library that speaks")
        print("and again")  # noqa: T201
    return {"bytes": np.frombuffer(data, np.uint8), "length": np.array([len(data)])}


def reasons(answers: list[Arrays | str]) -> list[str]:
    return [answer if isinstance(answer, str) else "" for answer in answers]


def test_answers_are_arrays_in_the_order_of_the_jobs() -> None:
    answers = decode_apart(f"{HERE}:decoder", [b"one", b"", b"three"])
    found = [answer["bytes"].tobytes() for answer in answers if not isinstance(answer, str)]
    assert found == [b"one", b"", b"three"]


def test_no_jobs_start_nothing() -> None:
    assert decode_apart("nowhere:nothing", []) == []


def test_a_crash_costs_its_own_job_alone() -> None:
    answers = decode_apart(f"{HERE}:decoder", [b"a", b"x", b"b", b"r", b"p"])
    crash = "data that crash the decoder"
    assert reasons(answers) == ["", crash, "", "no such thing", ""]


@pytest.mark.skipif(sys.platform != "linux", reason="limits of Linux")
def test_time_and_memory_are_limited() -> None:
    config = ApartConfig(seconds=0.3)
    late, large = reasons(decode_apart(f"{HERE}:decoder", [b"l", b"m"], config))
    assert late == "data that take too long to decode"
    assert large == "data that take too much memory to decode"


def test_larger_jobs_get_more_time_and_memory() -> None:
    data = b"-" * 3_000_000
    config = ApartConfig(memory=0, memory_per_byte=100)
    (answer,) = decode_apart(f"{HERE}:decoder", [data], config)
    assert not isinstance(answer, str)
    assert answer["length"].tolist() == [3_000_000]
