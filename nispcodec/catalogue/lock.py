"""One driver at a time on a catalogue, so that no two do the same work; shards have parts of it."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import BinaryIO

from nispcodec.catalogue.plan import Shard
from nispcodec.core.errors import NispError


@contextmanager
def locked(folder: Path, shard: Shard | None = None) -> Iterator[None]:
    """Hold a folder, or a shard's part of it, while others may hold other shards.

    The system lets go when a process ends, however it does. Raises NispError, naming the other
    process, where the folder or the part is held.
    """
    with ExitStack() as stack:
        _hold(stack, folder / "catalogue.lock", shared=shard is not None)
        if shard is not None:
            _hold(stack, folder / f"catalogue{shard.suffix}.lock", shared=False)
        yield


def _hold(stack: ExitStack, path: Path, shared: bool) -> None:
    import fcntl

    path.parent.mkdir(parents=True, exist_ok=True)
    file: BinaryIO = stack.enter_context(path.open("a+b"))
    try:
        fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB)
    except OSError as why:
        file.seek(0)
        holder = file.read(200).decode("utf-8", "replace").strip() or "another"
        raise NispError(
            f"{path.parent}: expected no other nisp batch at work here, found {holder}: wait for "
            f"it, or split the work with --shard"
        ) from why
    file.truncate(0)
    file.write(f"process {os.getpid()} on {socket.gethostname()}\n".encode())
    file.flush()
