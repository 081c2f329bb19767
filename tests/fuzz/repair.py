"""Makes a container of any bytes: true offsets and checksums, so that mutations reach the parser.

A fuzzer never guesses a CRC-32; without this it would stop at the first one.
"""

from __future__ import annotations

import struct
import zlib

HEADER, ENTRY = 16, 21


def repair(data: bytes) -> bytes:
    """The bytes with signature, section count, offsets, lengths and checksums put right.

    Codes, flags and payloads stay; a stored length is cut to what is left, and the last
    section takes it all. A valid file comes back as it is.
    """
    count = min(data[10] if len(data) > 10 else 0, (len(data) - HEADER) // ENTRY)
    if count < 1:
        return data
    offset = HEADER + ENTRY * count
    table = b""
    for row in range(count):
        code, flags, _, stored, decoded, _ = struct.unpack_from(
            "<4sBIIII", data, HEADER + ENTRY * row
        )
        left = len(data) - offset
        stored = left if row == count - 1 else min(stored, left)
        decoded = decoded if flags & 2 else stored
        checksum = zlib.crc32(data[offset : offset + stored])
        table += struct.pack("<4sBIIII", code, flags, offset, stored, decoded, checksum)
        offset += stored
    start = b"\x89NSP\r\n\x1a\n" + bytes([1, data[9], count, 0])
    head = start + struct.pack("<I", zlib.crc32(start + table))
    return head + table + data[HEADER + ENTRY * count :]
