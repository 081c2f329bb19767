"""Memory of a long encode that nobody needs any more: given back, so that the next stage has it."""

from __future__ import annotations

import ctypes
import gc
import sys

from nispcodec.core.progress import Listener, Progress


def freeing(listen: Listener) -> Listener:
    """A listener that gives memory back when a stage of the whole encode begins, and passes on.

    Frees at once what is only held by itself, as an encode before may have left; not at each stage,
    as looking for it takes a twentieth of a second, and longer in a large process.
    """
    last = ""

    def told(update: Progress) -> None:
        nonlocal last
        if not update.network and update.stage != last:
            last = update.stage
            give_back()
        listen(update)

    gc.collect()
    return told


def give_back() -> None:
    """Have the C library return what was freed and it keeps for later.

    glibc keeps arrays of up to 32 MB that were freed, as many as there were: half a gigabyte.
    """
    if sys.platform == "linux":
        # Other C libraries of Linux have no such function, and keep less.
        trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
        if trim:
            trim(0)
