"""A whole document to the bytes of a `.nisp` file and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from nispcodec.asset import Texture
from nispcodec.document import Document
from nispcodec.errors import FormatError
from nispcodec.format import canonical, metadata, weights
from nispcodec.format.constants import CRITICAL_SECTIONS, INFO, KNOWN_SECTIONS, META, NETS, TXTR
from nispcodec.format.container import Entry, content, read_container, write_container


@dataclass(frozen=True)
class SectionInfo:
    """One section of a file; `parts` splits its decoded bytes by what they hold, where it can."""

    code: str
    critical: bool
    packing: str
    offset: int
    stored_length: int
    decoded_length: int
    parts: Mapping[str, int]


def pack(document: Document, coding: str | None = None) -> bytes:
    """The bytes of a file. `coding` forces one weight coding; by default the smallest is taken.

    The same document gives the same bytes. Raises `FormatError` for a document beyond the caps.
    """
    sections = [
        (META, True, metadata.encode(document)),
        (NETS, True, weights.encode(document.networks, coding)),
    ]
    if document.textures:
        sections.append((TXTR, True, b"".join(texture.data for texture in document.textures)))
    if document.info:
        sections.append((INFO, False, canonical.encode(INFO, dict(document.info))))
    return write_container(sections)


def unpack(data: bytes) -> Document:
    """A file's bytes -> its document. Raises `FormatError` and nothing else, whatever the bytes."""
    entries = _known(read_container(data))
    meta = metadata.decode(_required(entries, META))
    networks = weights.decode(meta.specs, _required(entries, NETS))
    if "sdf" not in networks:
        raise FormatError(META, "networks.sdf", "present", "absent")
    return Document(
        frame=meta.frame,
        charts=meta.charts,
        materials=meta.materials,
        textures=_read_textures(meta, entries),
        sdf=networks["sdf"],
        chart=networks.get("chart"),
        uv=networks.get("uv"),
        shell=meta.shell,
        info=_read_info(entries),
    )


def inspect(data: bytes) -> list[SectionInfo]:
    """The sections of a valid file in file order, with what their bytes are spent on."""
    unpack(data)
    entries = read_container(data)
    meta = metadata.decode(_required(_known(entries), META))
    parts = {
        TXTR: {name: length for name, _, length in meta.textures},
        NETS: weights.sizes(meta.specs, _required(_known(entries), NETS)),
    }
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
        for entry in entries
    ]


def _known(entries: list[Entry]) -> dict[str, Entry]:
    for entry in entries:
        if entry.critical and entry.code not in CRITICAL_SECTIONS:
            known = ", ".join(sorted(CRITICAL_SECTIONS))
            raise FormatError(entry.code, "code", f"a critical section of {known}", entry.code)
        if not entry.critical and entry.code in CRITICAL_SECTIONS:
            raise FormatError(entry.code, "flags", "critical", "ancillary")
    return {entry.code: entry for entry in entries if entry.code in KNOWN_SECTIONS}


def _required(entries: Mapping[str, Entry], code: str) -> bytes:
    if code not in entries:
        raise FormatError(code, "section", "present", "absent")
    return content(entries[code])


def _read_textures(meta: metadata.Metadata, entries: Mapping[str, Entry]) -> tuple[Texture, ...]:
    data = content(entries[TXTR]) if TXTR in entries else b""
    textures: list[Texture] = []
    start = 0
    for name, mime, length in meta.textures:
        textures.append(Texture(name, data[start : start + length], mime))
        start += length
    if start != len(data):
        raise FormatError(TXTR, "length", start, len(data))
    return tuple(textures)


def _read_info(entries: Mapping[str, Entry]) -> dict[str, str | int | float | bool]:
    if INFO not in entries:
        return {}
    info = canonical.decode(INFO, content(entries[INFO]))
    plain = isinstance(info, dict) and all(
        type(key) is str and type(value) in (str, int, float, bool) for key, value in info.items()
    )
    if not plain:
        raise FormatError(INFO, "info", "a map from text to text, numbers and bools", "another")
    return dict(info)
