"""The content of the section MESH: its parts, one after the other, in one stream of bits."""

from __future__ import annotations

from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import MeshPart
from nispcodec.format.constants import MAX_MESH_FACES, MESH_FACES_PER_BYTE
from nispcodec.format.mesh import part as one_part
from nispcodec.format.mesh.binary_coder import SECTION, Decoder, Encoder
from nispcodec.format.mesh.fields import number


def encode(parts: tuple[MeshPart, ...]) -> bytes:
    """The section's content.

    Floats become float32. Vertices without faces are not kept, nor is which corners share a UV;
    charts that no edge connects come apart; vertices, faces, UVs and charts get the order of the
    file. What was decoded encodes to the same bytes again, where no edge has more than two faces;
    of others, other faces may meet.

    Raises FormatError for what the format does not hold: too many faces, faces with fewer than
    three vertices, negative materials.
    """
    faces = sum(len(part.faces) for part in parts)
    if faces > MAX_MESH_FACES:
        raise FormatError(SECTION, "faces", f"at most {MAX_MESH_FACES}", faces)
    coder = Encoder()
    number(coder, len(parts), MAX_MESH_FACES, "parts")
    for part in parts:
        one_part.code(coder, MAX_MESH_FACES, part)
    return coder.finish().ljust(-(-faces // MESH_FACES_PER_BYTE), b"\0")


def decode(data: bytes | memoryview) -> tuple[MeshPart, ...]:
    """The parts. Raises FormatError for any other bytes than `encode` can make."""
    coder = Decoder(data)
    left = min(MAX_MESH_FACES, MESH_FACES_PER_BYTE * len(data))
    parts = []
    for _ in range(number(coder, 0, left, "parts")):
        parts.append(one_part.code(coder, left, None))
        left -= len(parts[-1].faces)
    coder.finish()
    return tuple(parts)
