"""Samples of `nisp sample --count`, without those that are broken on purpose."""

from __future__ import annotations

from itertools import islice
from pathlib import Path

from nispcodec.io.save import write_mesh
from nispcodec.procedural.variety import VarietyConfig, catalogue

SEED = 7


USUAL = VarietyConfig()
SMALL = VarietyConfig(rows=(6, 10), bodies=1)
"""Some hundred faces, for when it is not the encoder that is looked at."""


def write_samples(folder: Path, count: int, variety: VarietyConfig = USUAL) -> Path:
    """Write so many sound assets -> the folder."""
    sound = (each for each in catalogue(2 * count, SEED, variety) if not each.broken)
    for each in islice(sound, count):
        path = folder / f"{each.way}{each.suffix}"
        path.parent.mkdir(parents=True, exist_ok=True)
        write_mesh(each.mesh, path)
    return folder
