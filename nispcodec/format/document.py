"""A whole document to the bytes of a `.nisp` file and back."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from nispcodec.core.asset import Texture
from nispcodec.core.document import Document, Field, StoredSection
from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import PART, MeshPart
from nispcodec.format import mesh, metadata, weights
from nispcodec.format.constants import MESH, META, NETS, SECTIONS, TXTR
from nispcodec.format.container import Entry, content, read_container, write_container
from nispcodec.format.record import located


@dataclass(frozen=True)
class SectionInfo:
    """One section of a file.

    Lengths and offset are in bytes; `parts` splits the decoded length of NETS by network and that
    of TXTR by texture.
    """

    code: str
    critical: bool
    packing: str
    offset: int
    stored_length: int
    decoded_length: int
    parts: Mapping[str, int]


def pack(document: Document, coding: str | None = None) -> bytes:
    """The bytes of a file. `coding` forces one weight coding; by default the smallest is taken.

    The same document gives the same bytes. Raises FormatError for a document beyond the caps, an
    unknown coding, and weights that are not multiples of their step.
    """
    if known := sorted(set(document.extra) & set(SECTIONS)):
        raise FormatError(known[0], "extra", "a code unknown to this version", known[0])
    sections = [
        (META, True, metadata.encode(document)),
    ]
    if document.field:
        sections.append((NETS, True, weights.encode(document.networks, coding)))
    if document.meshes:
        sections.append((MESH, True, mesh.encode(document.meshes)))
    if document.textures:
        sections.append((TXTR, True, b"".join(texture.data for texture in document.textures)))
    return write_container(sections, document.extra)


def unpack(data: bytes) -> Document:
    """A file's bytes -> its document. Raises FormatError and nothing else, whatever the bytes."""
    return _parse(data)[0]


def inspect(data: bytes) -> list[SectionInfo]:
    """The sections of a file in file order, with what their bytes are spent on.

    Raises FormatError as `unpack` does.
    """
    document, entries, lengths = _parse(data)
    images = {texture.name: len(texture.data) for texture in document.textures}
    parts: dict[str, Mapping[str, int]] = {NETS: lengths, TXTR: images}
    return [
        SectionInfo(
            code=entry.code,
            critical=entry.critical,
            packing=entry.packing,
            offset=entry.offset,
            stored_length=entry.stored_length,
            decoded_length=entry.decoded_length,
            parts=parts.get(entry.code, {}),
        )
        for entry in entries.values()
    ]


def own_bytes(data: bytes) -> int:
    """Bytes of a file without its images, as they are stored in it.

    Raises FormatError for a file whose header, table or checksums are wrong.
    """
    entries = read_container(data)
    return len(data) - sum(each.stored_length for each in entries if each.code == TXTR)


def _parse(data: bytes) -> tuple[Document, dict[str, Entry], dict[str, int]]:
    """Document, table entries by code, bytes of each network in NETS."""
    entries = _by_code(read_container(data))
    meta = metadata.decode(_required(entries, META))
    field, lengths = _read_field(meta, entries)
    meshes: tuple[MeshPart, ...] = ()
    if MESH in entries or field is None:
        meshes = mesh.decode(_required(entries, MESH))
    textures = _read_textures(meta, entries)
    unknown = {code: entry for code, entry in entries.items() if code not in SECTIONS}
    with _located_in_meta_or_mesh():
        document = Document(
            frame=meta.frame,
            materials=meta.materials,
            textures=textures,
            field=field,
            meshes=meshes,
            info=meta.info,
            extra={code: _kept(entry) for code, entry in unknown.items()},
        )
    return document, entries, lengths


@contextmanager
def _located_in_meta_or_mesh() -> Iterator[None]:
    """Raises a document's errors as those of the section that has what is wrong."""
    try:
        yield
    except FormatError as error:
        section = MESH if error.section == PART else META
        raise FormatError(section, error.field, error.expected, error.found) from error


def _read_field(
    meta: metadata.Metadata, entries: Mapping[str, Entry]
) -> tuple[Field | None, dict[str, int]]:
    """The field, if META has networks, and the bytes of each network in NETS."""
    if meta.charts is None:
        if NETS in entries:
            raise FormatError(NETS, "section", "absent without networks", "present")
        return None, {}
    networks, lengths = weights.decode(meta.specs, _required(entries, NETS))
    with located(META, ""):
        field = Field(
            charts=meta.charts,
            sdf=networks["sdf"],
            chart=networks.get("chart"),
            uv=networks.get("uv"),
            half_thickness=meta.half_thickness,
        )
    return field, lengths


def _by_code(entries: list[Entry]) -> dict[str, Entry]:
    for entry in entries:
        known = entry.code in SECTIONS
        if entry.critical and not known:
            expected = f"a critical section of {', '.join(SECTIONS)}"
            raise FormatError(entry.code, "section_code", expected, entry.code)
        if known and not entry.critical:
            raise FormatError(entry.code, "flags", "critical", "ancillary")
    return {entry.code: entry for entry in entries}


def _required(entries: Mapping[str, Entry], code: str) -> memoryview:
    if code not in entries:
        raise FormatError(code, "section", "present", "absent")
    return content(entries[code])


def _kept(entry: Entry) -> StoredSection:
    length = entry.decoded_length if entry.packing == "zstd" else None
    return StoredSection(bytes(entry.payload), length)


def _read_textures(meta: metadata.Metadata, entries: Mapping[str, Entry]) -> tuple[Texture, ...]:
    if not meta.textures and TXTR in entries:
        raise FormatError(TXTR, "section", "absent without textures", "present")
    data = _required(entries, TXTR) if meta.textures else memoryview(b"")
    others = sum(length for _, _, length in meta.textures if length is not None)
    if meta.textures and others >= len(data):
        raise FormatError(TXTR, "length", f"more than {others} bytes", len(data))
    textures: list[Texture] = []
    start = 0
    for name, mime, length in meta.textures:
        end = len(data) if length is None else start + length
        textures.append(Texture(name, bytes(data[start:end]), mime))
        start = end
    return tuple(textures)
