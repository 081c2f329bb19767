"""A grid of signed distances as an `.npz`: arrays of numpy in a zip file, here not compressed."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO
from zipfile import ZipFile

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.atomic_write import write_atomic
from nispcodec.core.errors import NispError
from nispcodec.core.progress import Listener, Progress
from nispcodec.core.sdf_grid import SdfGrid

SIGN = "negative inside"
UNITS = "those of the asset; sdf[i, j, k] is at origin + spacing * (i, j, k)"


def write_grid(grid: SdfGrid, path: Path, progress: Listener) -> None:
    """Write the grid a slab at a time; see `SdfGrid.save`.

    Raises NispError, before the work too, where the disk has no room for it.
    """
    _expect_room(path, 4 * int(np.prod(grid.shape, dtype=np.int64)))
    write_atomic(path, lambda file: _write(file, grid, progress))


def _write(file: BinaryIO, grid: SdfGrid, progress: Listener) -> None:
    about = {"origin": grid.origin, "spacing": grid.spacing, "sign": SIGN, "units": UNITS}
    header = {"descr": "<f4", "fortran_order": False, "shape": grid.shape}
    with ZipFile(file, "w") as archive:
        for name, value in about.items():
            with archive.open(f"{name}.npy", "w") as member:
                np.lib.format.write_array(member, np.asarray(value), allow_pickle=False)
        with archive.open("sdf.npy", "w", force_zip64=True) as member:
            np.lib.format.write_array_header_1_0(member, header)
            for slab in _told(grid, progress):
                member.write(slab.astype("<f4").tobytes())


def _told(grid: SdfGrid, progress: Listener) -> Iterator[Float32Array]:
    """The slabs; progress hears of each."""
    done, planes = 0, grid.shape[0]
    for slab in grid.slabs():
        yield slab
        done += len(slab)
        progress(Progress(stage="grid", step=done, steps=planes, overall=done / planes))


def _expect_room(path: Path, needed: int) -> None:
    free = shutil.disk_usage(path.parent).free if path.parent.is_dir() else needed
    if needed > free:
        raise NispError(f"{path}: expected room for {needed:,} bytes, found {free:,} free")
