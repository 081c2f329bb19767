"""A new atlas, made in a process of its own: a crash of the native library ends that one alone."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
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
    try:
        with ProcessPoolExecutor(1, context) as pool:
            return pool.submit(make, mesh).result()
    except BrokenProcessPool as why:
        raise NispError(
            f"{mesh.name}: expected an atlas, found a crash while unwrapping {len(mesh.faces):,} "
            f"faces: simplify or mend the mesh, or unwrap it in a modeling tool"
        ) from why
