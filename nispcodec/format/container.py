"""The container: signature, version, section table, payloads. It knows nothing of their content."""

from __future__ import annotations

import re
import struct
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from zlib import crc32

import zstandard

from nispcodec.core.document import StoredSection
from nispcodec.core.errors import FormatError
from nispcodec.format.constants import (
    CRITICAL,
    ENTRY_SIZE,
    HEADER_SIZE,
    MAJOR,
    MAX_FILE,
    MAX_SECTIONS,
    MAX_UNPACKED,
    MINOR,
    PACKED,
    SIGNATURE,
)

_HEADER = struct.Struct("<8sBBHI")
_ENTRY = struct.Struct("<4sBIIII")
_CODE = re.compile(rb"[A-Z0-9]{4}")
_DESCRIPTOR = 4
"""The byte of a zstd frame that says what is in its header (RFC 8878, 3.1.1.1.1)."""
_UNWANTED = 0b111
_ZSTD_LEVEL = 19
_ZSTD_LEVEL_LARGE = 3
_LARGE = 2**20


@dataclass(frozen=True)
class Entry:
    """One row of the section table, as on disk; `payload` is still packed."""

    code: str
    critical: bool
    packing: str
    offset: int
    decoded_length: int
    payload: memoryview = field(repr=False)

    @property
    def stored_length(self) -> int:
        """Bytes of the payload in the file."""
        return len(self.payload)


def write_container(
    sections: Iterable[tuple[str, bool, bytes]], stored: Mapping[str, StoredSection]
) -> bytes:
    """(code, critical, content) of every section, in any order -> the bytes of the file.

    `stored` are ancillary sections, by code, whose payloads are written as they are. Raises
    FormatError for a code that is not four of A-Z and 0-9, two equal codes, and beyond the caps.
    """
    rows = sorted(_packed(sections, stored), key=lambda row: row[0])
    if len(rows) > MAX_SECTIONS:
        raise FormatError("header", "section_count", f"1 to {MAX_SECTIONS}", len(rows))
    _check_order([_check_code(code.encode(errors="replace")) for code, _, _ in rows])
    offset = HEADER_SIZE + ENTRY_SIZE * len(rows)
    table = b""
    for code, critical, (payload, decoded) in rows:
        flags = CRITICAL * critical | PACKED * (decoded is not None)
        length = len(payload) if decoded is None else decoded
        table += _ENTRY.pack(code.encode(), flags, offset, len(payload), length, crc32(payload))
        offset += len(payload)
        if offset > MAX_FILE:
            raise FormatError(code, "file_length", f"at most {MAX_FILE} bytes", offset)
    start = _HEADER.pack(SIGNATURE, MAJOR, MINOR, len(rows), 0)[:12]
    payloads = [payload for _, _, (payload, _) in rows]
    return b"".join([start, struct.pack("<I", crc32(start + table)), table, *payloads])


def read_container(data: bytes) -> list[Entry]:
    """The section table of a file's bytes, in file order; copies and unpacks nothing.

    Everything up to the checksums of the payloads is checked. Raises FormatError naming the section
    ("header" for the part before the payloads).
    """
    count = _read_header(data)
    end = HEADER_SIZE + ENTRY_SIZE * count
    entries: list[Entry] = []
    for row in range(count):
        entries.append(_read_entry(data, row, end))
        end += entries[-1].stored_length
    if end != len(data):
        raise FormatError("header", "file_length", f"{end} bytes", len(data))
    _check_order([entry.code for entry in entries])
    unpacked = sum(entry.decoded_length for entry in entries if entry.packing == "zstd")
    if unpacked > MAX_UNPACKED:
        raise FormatError("header", "decoded_length", f"{MAX_UNPACKED} in all", unpacked)
    return entries


def content(entry: Entry) -> memoryview:
    """The unpacked payload of one section; allocates its decoded length if packed, else nothing.

    Raises FormatError for a payload that is not one zstd frame of that length.
    """
    if entry.packing == "raw":
        return entry.payload
    try:
        declared = zstandard.get_frame_parameters(entry.payload).content_size
        if entry.payload[_DESCRIPTOR] & _UNWANTED:
            expected = "a zstd frame without dictionary ID and checksum"
            raise FormatError(entry.code, "payload", expected, bytes(entry.payload[:5]))
        if declared != entry.decoded_length:
            raise FormatError(entry.code, "content_size", entry.decoded_length, declared)
        unpacked = zstandard.ZstdDecompressor().decompress(
            entry.payload, max_output_size=entry.decoded_length, allow_extra_data=False
        )
    except zstandard.ZstdError as error:
        raise FormatError(entry.code, "payload", "one zstd frame", error) from error
    if len(unpacked) != entry.decoded_length:
        raise FormatError(entry.code, "decoded_length", entry.decoded_length, len(unpacked))
    return memoryview(unpacked)


def pack_content(content: bytes, budget: int) -> tuple[str, bytes]:
    """Packing, "raw" or "zstd", and payload: the shorter of both, raw beyond `budget` bytes."""
    level = _ZSTD_LEVEL if len(content) < _LARGE else _ZSTD_LEVEL_LARGE
    squeezed = zstandard.ZstdCompressor(level=level, write_content_size=True).compress(content)
    if len(squeezed) < len(content) <= budget:
        return "zstd", squeezed
    return "raw", content


def _packed(
    sections: Iterable[tuple[str, bool, bytes]], stored: Mapping[str, StoredSection]
) -> Iterator[tuple[str, bool, tuple[bytes, int | None]]]:
    """Code, whether critical, and payload with decoded length, None if raw, of every section."""
    budget = MAX_UNPACKED - sum(each.decoded_length or 0 for each in stored.values())
    for code, critical, content in sorted(sections):
        packing, payload = pack_content(content, budget)
        budget -= len(content) if packing == "zstd" else 0
        yield code, critical, (payload, len(content) if packing == "zstd" else None)
    for code, each in stored.items():
        yield code, False, (each.payload, each.decoded_length)


def _read_header(data: bytes) -> int:
    if not HEADER_SIZE <= len(data) <= MAX_FILE:
        expected = f"{HEADER_SIZE} to {MAX_FILE} bytes"
        raise FormatError("header", "file_length", expected, len(data))
    signature, major, _minor, count, checksum = _HEADER.unpack_from(data)
    if signature != SIGNATURE:
        raise FormatError("header", "signature", SIGNATURE, signature)
    if major != MAJOR:
        raise FormatError("header", "major_version", MAJOR, major)
    if not 1 <= count <= MAX_SECTIONS:
        raise FormatError("header", "section_count", f"1 to {MAX_SECTIONS}", count)
    end = HEADER_SIZE + ENTRY_SIZE * count
    if len(data) < end:
        raise FormatError("header", "file_length", f"at least {end} bytes", len(data))
    found = crc32(data[:12] + data[HEADER_SIZE:end])
    if found != checksum:
        raise FormatError("header", "checksum", f"{found:#010x}", f"{checksum:#010x}")
    return int(count)


def _read_entry(data: bytes, row: int, start: int) -> Entry:
    raw_code, flags, offset, stored, decoded, checksum = _ENTRY.unpack_from(
        data, HEADER_SIZE + ENTRY_SIZE * row
    )
    code = _check_code(raw_code)
    if flags & ~(CRITICAL | PACKED):
        raise FormatError(code, "flags", f"0 to {CRITICAL | PACKED}", flags)
    packed = bool(flags & PACKED)
    if offset != start:
        raise FormatError(code, "offset", start, offset)
    if stored > len(data) - start:
        raise FormatError(code, "stored_length", f"at most {len(data) - start}", stored)
    if not packed and decoded != stored:
        raise FormatError(code, "decoded_length", stored, decoded)
    if packed and decoded <= stored:
        raise FormatError(code, "decoded_length", f"more than the {stored} stored", decoded)
    payload = memoryview(data)[start : start + stored]
    if crc32(payload) != checksum:
        raise FormatError(code, "checksum", f"{crc32(payload):#010x}", f"{checksum:#010x}")
    packing = "zstd" if packed else "raw"
    return Entry(code, bool(flags & CRITICAL), packing, offset, decoded, payload)


def _check_code(code: bytes) -> str:
    if not _CODE.fullmatch(code):
        raise FormatError("header", "section_code", "four of A-Z and 0-9", code)
    return code.decode()


def _check_order(codes: list[str]) -> None:
    if codes != sorted(set(codes)):
        raise FormatError("header", "section_order", sorted(set(codes)), codes)
