"""A new atlas, made in a process of its own: a crash of the native library ends that one alone."""

from __future__ import annotations

import multiprocessing
import signal
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from nispcodec.core.asset import TexturedMesh


def unwrapped(mesh: TexturedMesh) -> TexturedMesh:
    """The mesh with UVs of its own; a warning counts faces that have none with an area.

    Raises NispError without the extra `unwrap`, and where unwrapping crashes.
    """
    from nispcodec.bake.unwrap import unwrap, with_collapsed_named
    from nispcodec.core.extras import require

    require("xatlas", extra="unwrap", what_for="unwrapping")
    return with_collapsed_named(apart(unwrap, mesh))


def apart(make: Callable[[TexturedMesh], TexturedMesh], mesh: TexturedMesh) -> TexturedMesh:
    """What `make`, a function of a module, makes of the mesh in another process.

    Raises what it raises, and NispError where the process ends without a result.
    """
    from nispcodec.core.errors import NispError

    context = multiprocessing.get_context("spawn")
    answer, told = context.Pipe(duplex=False)
    child = context.Process(target=_tell, args=(told, make, mesh), daemon=True)
    child.start()
    told.close()  # so that the end of the process is the end of what it tells
    try:
        found = answer.recv()
    except EOFError as why:
        raise NispError(
            f"{mesh.name}: expected an atlas, found a crash while unwrapping {len(mesh.faces):,} "
            f"faces: simplify or mend the mesh, or unwrap it in a modeling tool"
        ) from why
    finally:
        child.kill()  # Ctrl-C does not wait for it
        child.join()
    if isinstance(found, BaseException):
        raise found
    return found


def _tell(
    told: Connection, make: Callable[[TexturedMesh], TexturedMesh], mesh: TexturedMesh
) -> None:
    """The work of the process. Ctrl-C reaches it too, and is answered by the one that asked."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        told.send(make(mesh))
    except Exception as error:
        told.send(error)
