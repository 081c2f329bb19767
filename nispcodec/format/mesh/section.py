"""The content of the section MESH: its parts, one after the other, in one stream of bits."""

from __future__ import annotations

from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import MeshPart, check_placed_faces
from nispcodec.format.constants import MAX_MESH_FACES, MESH_FACES_PER_BYTE
from nispcodec.format.mesh import part as one_part
from nispcodec.format.mesh.binary_coder import SECTION, Decoder, Encoder
from nispcodec.format.mesh.fields import number
from nispcodec.format.record import located


def encode(parts: tuple[MeshPart, ...]) -> bytes:
    """The section's content.

    Floats become float32. Vertices without faces are not kept, nor is which corners share a UV;
    charts that no edge connects come apart; vertices, faces, UVs and charts get the order of the
    file. What was decoded encodes to the same bytes again, where no edge has more than two faces;
    of others, other faces may meet.

    Raises FormatError for what the format does not hold: too many faces or copies, faces with fewer
    than three vertices, negative materials.
    """
    with located(SECTION, ""):
        check_placed_faces(sum(part.placed_faces for part in parts))
    coder = Encoder()
    number(coder, len(parts), MAX_MESH_FACES, "parts")
    left = MAX_MESH_FACES
    for part in parts:
        _, left = one_part.code(coder, left, part)
    return coder.finish().ljust(-(-(MAX_MESH_FACES - left) // MESH_FACES_PER_BYTE), b"\0")


def decode(data: bytes | memoryview) -> tuple[MeshPart, ...]:
    """The parts. Raises FormatError for any other bytes than `encode` can make."""
    coder = Decoder(data)
    left = min(MAX_MESH_FACES, MESH_FACES_PER_BYTE * len(data))
    parts: list[MeshPart] = []
    placed = 0
    count = number(coder, 0, left, "parts")
    if count == 0:
        raise FormatError(SECTION, "parts", "at least one", 0)
    for _ in range(count):
        part, left = one_part.code(coder, left, None)
        placed += part.placed_faces
        with located(SECTION, ""):
            check_placed_faces(placed)
        parts.append(part)
    coder.finish()
    return tuple(parts)
