"""Cores: the first fit has one to itself, nobody has more than there are, none lies idle."""

from __future__ import annotations

import threading
from contextlib import ExitStack

import pytest

from nispcodec.train.cores import Cores, Stopped, one_core


def entered(cores: Cores, number: int) -> bool:
    """Whether that fit gets a core within a moment; it leaves it at once."""
    got = threading.Event()

    def enter() -> None:
        with cores.of(number)():
            got.set()

    thread = threading.Thread(target=enter, daemon=True)
    thread.start()
    return got.wait(0.2)


def test_the_first_has_a_core_to_itself_and_the_others_share_what_is_left() -> None:
    cores = Cores(2, 3)
    with cores.of(1)():
        assert entered(cores, 0)
        assert not entered(cores, 2)


def test_the_core_of_the_first_is_for_the_others_when_it_is_done() -> None:
    cores = Cores(2, 3)
    cores.done(0)
    with cores.of(1)():
        assert entered(cores, 2)


def test_one_core_is_for_one_at_a_time() -> None:
    cores = Cores(1, 2)
    with cores.of(0)():
        assert not entered(cores, 1)


@pytest.mark.parametrize(("count", "done", "threads"), [(2, 0, 1), (2, 2, 2), (8, 0, 6), (8, 2, 8)])
def test_cores_that_nobody_needs_are_the_first_ones(count: int, done: int, threads: int) -> None:
    cores = Cores(count, 3)
    for number in range(1, done + 1):
        cores.done(number)
    with cores.of(0)() as given:
        assert given == threads


@pytest.mark.parametrize("number", [0, 1])
def test_who_asks_after_the_stop_is_stopped(number: int) -> None:
    cores = Cores(2, 2)
    cores.stop()
    with ExitStack() as stack, pytest.raises(Stopped):
        stack.enter_context(cores.of(number)())


def test_a_fit_that_is_alone_has_one() -> None:
    with one_core() as threads:
        assert threads == 1
