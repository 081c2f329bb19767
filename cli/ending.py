"""SIGTERM ends the work as Ctrl-C does: what is half done is cleared away first."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn


class Terminated(BaseException):
    """SIGTERM came."""


@contextmanager
def ending_on_sigterm() -> Iterator[None]:
    """Raises Terminated in this block when SIGTERM comes; the main thread alone can have it so."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, _end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _end(_: int, __: FrameType | None) -> NoReturn:
    raise Terminated
