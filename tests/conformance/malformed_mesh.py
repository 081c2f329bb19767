"""Ways of failing that mesh parts have: in MESH, and in META where there is no field."""

from __future__ import annotations

import random
import struct
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from typing import Any

import msgpack
import numpy as np
import zstandard

from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import MeshPart, Placement
from nispcodec.format import mesh
from nispcodec.format.constants import MAX_MESH_FACES, MESH_FACES_PER_BYTE
from nispcodec.format.mesh import part as one_part
from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import Encoder
from nispcodec.format.mesh.fields import number
from nispcodec.format.mesh.numbers import DOWN, UP
from tests.conformance.builder import Malformed, Row, change, container
from tests.conformance.mesh_features import box, grid, soup, three_sheets

META = {1: [0.0, 0.0, 0.0, 1.0]}
PLACE = Placement(
    (0.5, 0.5, -0.5, 0.5), (0.1, 0.2, 0.3), 0.75, False, (0.375, 1.0), (0.625, 0.0),
    np.zeros(1, np.int32),
)  # fmt: skip
NAN, INFINITE = 0x7FC00000, 0x7F800000


class Forger(Encoder):
    """Writes some numbers otherwise than it is told; whoever calls it does not notice.

    calls   {which call of `bits`: (value, how many bits)}
    values  {(value, how many bits): value}, floats as their 32 bits
    below   {name: value}, of those that have to be below some number
    yes     slots of decisions that are always yes, of which the caller hears
    """

    def __init__(
        self,
        calls: dict[int, tuple[int, int]] | None = None,
        values: dict[tuple[int, int], int] | None = None,
        below: dict[str, int] | None = None,
        yes: tuple[int, ...] = (),
    ) -> None:
        super().__init__()
        self._calls, self._values, self._below = calls or {}, values or {}, below or {}
        self._count, self._yes = 0, yes

    def bit(self, value: int, slot: int, general: int, medium: int, special: int) -> int:
        """Likewise, or yes."""
        return super().bit(int(value or slot in self._yes), slot, general, medium, special)

    def bits(self, value: int, count: int) -> int:
        """As it is told, or forged; the value that it was told."""
        usual = self._values.get((value, count), value), count
        super().bits(*self._calls.get(self._count, usual))
        self._count += 1
        return value

    def below(self, value: int, end: int, name: str) -> int:
        """Likewise."""
        super().below(min(self._below.get(name, value), end - 1), end, name)
        return value


def forged(part: MeshPart, **forgery: Any) -> bytes:
    """The content with one part, some of its numbers forged."""
    coder = Forger(**forgery)
    number(coder, 1, 1, "parts")
    with suppress(FormatError):
        one_part.code(coder, MAX_MESH_FACES, part)
    return coder.finish()


def rows(content: bytes, changes: dict[int, Any] | None = None) -> list[Row]:
    """A file without a field."""
    fields = {**META, **(changes or {})}
    listed = {key: fields[key] for key in sorted(fields)}
    return [
        Row(b"MESH", content),
        Row(b"META", bytes(msgpack.packb(listed, use_single_float=True))),
    ]


def single(value: float) -> tuple[int, int]:
    """A float as `Forger` has it."""
    return struct.unpack("<I", struct.pack("<f", value))[0], 32


def mesh_malformed() -> Iterator[Malformed]:
    """Every way of failing that has to do with mesh parts."""
    yield from _sections()
    for name, content, field in (
        *_lengths(),
        *_counts(),
        *_part_numbers(),
        *_placements(),
        *_copies(),
        *_found(),
    ):
        yield Malformed(f"mesh-{name}", container(rows(content)), "MESH", field)


def _sections() -> Iterator[Malformed]:
    sound = mesh.encode((box(),))
    two = rows(sound)
    yield Malformed("mesh-missing", container(two[1:]), "MESH", "section")
    yield Malformed("mesh-ancillary", container(change(two, b"MESH", flags=0)), "MESH", "flags")
    unasked = [*two, Row(b"NETS", b"")]
    yield Malformed("nets-without-networks", container(unasked), "NETS", "section")
    alone: dict[str, dict[int, Any]] = {
        "charts": {3: 2},
        "chart-materials": {4: b"\1"},
        "chart-has-uv": {5: b"\0"},
        "uv-map": {6: [0.0, 0.0, 2.0, 2.0]},
        "half-thickness": {9: 0.5},
        "openings": {11: True},
    }
    for name, changes in alone.items():
        file = container(rows(sound, changes))
        yield Malformed(f"{name}-without-networks", file, "META", "document.keys")
    none = container(rows(sound, {2: {}}))
    yield Malformed("networks-none-beside-mesh", none, "META", "networks.sdf")
    capital = box(chart_materials=np.ones(1, np.int32))
    file = container(rows(mesh.encode((capital,))))
    yield Malformed("mesh-material-unknown", file, "MESH", "materials")
    crowd = zeros(forged(box(), calls={2: (19, 5), 3: (1, 18)}), 4097)
    packed = zstandard.ZstdCompressor(level=19).compress(crowd)
    claim = {"payload": packed, "flags": 3, "decoded": len(crowd)}
    many = container(change(rows(crowd), b"MESH", **claim))
    yield Malformed("mesh-faces-many", many, "MESH", "faces")


Case = tuple[str, bytes, str]


def zeros(content: bytes, length: int) -> bytes:
    """The content with bytes of 0 after it."""
    return content.ljust(length, b"\0")


def _lengths() -> Iterator[Case]:
    sound = mesh.encode((box(),))
    yield "end", sound + bytes(4) + b"\1", "end"
    yield "end-zeros-between", sound + bytes(40) + b"\1", "end"
    cuts = (sound[:length] for length in range(len(sound), 0, -1))
    yield "cut", next(cut for cut in cuts if _field(cut) == "bytes"), "bytes"


def _counts() -> Iterator[Case]:
    sound = mesh.encode((box(),))
    over = MESH_FACES_PER_BYTE * len(sound) + 1
    size = over.bit_length()
    rest = over - (1 << size - 1)
    yield "parts-none", b"", "parts"
    yield "parts-many", forged(box(), calls={0: (size + 1, 5), 1: (0, size)}), "parts"
    yield "faces-none", forged(box(), calls={2: (0, 5), 3: (0, 0)}), "faces"
    many = forged(box(), calls={2: (size + 1, 5), 3: (rest, size)})
    yield "faces-more-than-bytes", many, "faces"
    three = replace(box(), placements=(Placement(),) * 3)
    none = {(2, 5): 0, (1, 1): 0}
    yield "placements-none", forged(three, values=none), "placements"
    yield "placements-more-than-bytes", forged(three, values={(2, 5): 14}), "placements"
    yield "placements-many", zeros(forged(three, values={(2, 5): 14}), 300), "placements"


def _part_numbers() -> Iterator[Case]:
    yield "position-bits", forged(box(), calls={4: (21, 5)}), "position_bits"
    yield "uv-bits", forged(box(), calls={5: (21, 5)}), "uv_bits"
    odd = grid(1, step=0.375, origin=(0.625, 0.0, 0.0), uv_step=(0.75, 1.0), uv_origin=(0.125, 0.0))
    negative = single(-0.375)[0]
    for kind, pattern in {"zero": 0, "negative": negative, "nan": NAN, "inf": INFINITE}.items():
        yield f"step-{kind}", forged(odd, values={single(0.375): pattern}), "step"
    yield "origin-nan", forged(odd, values={single(0.625): NAN}), "origin"
    yield "uv-step-infinite", forged(odd, values={single(0.75): INFINITE}), "uv_step"
    yield "uv-origin-nan", forged(odd, values={single(0.125): NAN}), "uv_origin"
    colored = grid(1, chart_materials=np.array([21], np.int32))
    yield "material-bits", forged(colored, values={(5, 5): 17}), "material_bits"


def _placements() -> Iterator[Case]:
    made = replace(box(), placements=(PLACE,))
    cases = {
        "rotation-nan": (0.5, NAN, "rotation"),
        "rotation-long": (0.5, single(0.50048828125)[0], "rotation"),
        "rotation-short": (-0.5, 0, "rotation"),
        "offset-infinite": (0.1, INFINITE, "offset"),
        "scale-zero": (0.75, 0, "scale"),
        "scale-negative": (0.75, single(-0.75)[0], "scale"),
        "scale-nan": (0.75, NAN, "scale"),
        "uv-scale-nan": (0.375, NAN, "uv_scale"),
        "uv-offset-infinite": (0.625, INFINITE, "uv_offset"),
    }
    for name, (value, pattern, field) in cases.items():
        yield name, forged(made, values={single(value): pattern}), field
    bright = replace(PLACE, materials=np.array([1], np.int32))
    yield (
        "placement-material",
        mesh.encode((replace(box(), placements=(PLACE, bright)),)),
        "materials",
    )


def _copies() -> Iterator[Case]:
    """Small contents of which there would be too much."""
    large = grid(17, 0.0)
    copies = replace(large, placements=(Placement(),) * 4096)
    yield "placed-faces", forged(copies), "placed_faces"
    apart = _apart(6)
    yield "charts-many", mesh.encode((replace(apart, placements=(Placement(),) * 1000),)), "charts"
    dyed = Placement(materials=np.zeros(72, np.int32))
    content = mesh.encode((replace(apart, placements=(dyed,) * 800),))
    yield "placement-materials", content.rstrip(b"\0"), "placement_materials"


def _apart(side: int) -> MeshPart:
    """A grid each of whose faces is a chart."""
    made = grid(side, 0.0)
    count = len(made.faces)
    return replace(
        made,
        uv_faces=np.full((count, 3), -1, np.int32),
        face_charts=np.arange(count, dtype=np.int32),
        chart_materials=np.zeros(count, np.int32),
        chart_has_uv=np.zeros(count, np.bool_),
    )


def _found() -> Iterator[Case]:
    """What no forgery reaches directly: contents with bytes changed until they fail so."""
    yield "face-of-two", forged(three_sheets(), below={"copy": 0}), "faces"
    longer = tuple(range(slots.POSITION_START + UP, slots.POSITION_START + DOWN))
    yield "number", forged(box(), yes=longer), "number"
    seeds: dict[str, tuple[Callable[[], MeshPart], int]] = {
        "coordinate": (soup, 0),
        "third_point": (three_sheets, 1),
        "copy": (soup, 6),
        "uv": (soup, 16),
        "steps": (soup, 19),
        "uv_rank": (soup, 77),
        "gate": (soup, 303),
        "point": (three_sheets, 503),
    }
    for field, (made, seed) in seeds.items():
        yield field.replace("_", "-"), _mutated(made(), seed), field


def _mutated(part: MeshPart, seed: int) -> bytes:
    """A content that is random from some byte on."""
    generator, content = random.Random(seed), mesh.encode((part,))
    place = generator.randrange(8, len(content))
    return content[:place] + generator.randbytes(len(content) - place)


def _field(content: bytes) -> str | None:
    """The field that is wrong."""
    try:
        mesh.decode(content)
    except FormatError as error:
        return error.field
    return None
