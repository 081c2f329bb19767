"""Where the copies of a part stand."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Int32Array
from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import Placement
from nispcodec.format.constants import MAX_MESH_PLACEMENTS
from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder
from nispcodec.format.mesh.charts import Charts
from nispcodec.format.mesh.fields import flag, member, number, single
from nispcodec.format.record import located


def code(
    coder: BinaryCoder, charts: Charts, most: int, given: tuple[Placement, ...] | None
) -> tuple[tuple[Placement, ...], int]:
    """All placements, and what they and their materials leave of `most`. Raises FormatError."""
    if flag(coder, _is_plain(given), slots.ONE_PLACE):
        return (Placement(),), most
    count = number(coder, len(given or ()), min(MAX_MESH_PLACEMENTS, most), "placements")
    most -= count
    if count == 0:
        raise FormatError(SECTION, "placements", "at least one", 0)
    found = []
    for place in range(count):
        wanted = given[place] if given is not None else Placement()
        found.append(_code(coder, charts, most, wanted))
        most -= len(charts.materials) if found[-1].materials is not None else 0
    return tuple(found), most


def _is_plain(given: tuple[Placement, ...] | None) -> bool:
    if given is None or len(given) != 1 or given[0].materials is not None:
        return False
    return given[0] == Placement()


def _code(coder: BinaryCoder, charts: Charts, most: int, given: Placement) -> Placement:
    rotation = _singles(coder, given.rotation, slots.ROTATION, "rotation")
    offset = _singles(coder, given.offset, slots.OFFSET, "offset")
    scale = single(coder, given.scale, slots.SCALE, "scale")
    mirrored = flag(coder, given.mirrored, slots.MIRRORED)
    uv_scale = _singles(coder, given.uv_scale, slots.UV_SCALE, "uv_scale")
    uv_offset = _singles(coder, given.uv_offset, slots.UV_OFFSET, "uv_offset")
    materials = None
    if flag(coder, given.materials is not None, slots.HAS_MATERIALS):
        materials = _materials(coder, charts, most, given.materials)
    w, x, y, z = rotation
    right, up, front = offset
    (su, sv), (u, v) = uv_scale, uv_offset
    turn, shift = (w, x, y, z), (right, up, front)
    with located(SECTION, ""):
        return Placement(turn, shift, scale, mirrored, (su, sv), (u, v), materials)


def _singles(coder: BinaryCoder, given: tuple[float, ...], slot: int, name: str) -> list[float]:
    return [single(coder, value, slot, name) for value in given]


def _materials(
    coder: BinaryCoder, charts: Charts, most: int, given: Int32Array | None
) -> Int32Array:
    count = len(charts.materials)
    if count > most:
        raise FormatError(SECTION, "placement_materials", f"at most {most} more", count)
    wanted = [0] * count if given is None else given[charts.given].tolist()
    found = [0]
    for material in wanted:
        found.append(member(coder, material, charts.bits, found[-1]))
    return np.array(found[1:], np.int32)
