"""Names and numbers of the container, version 1: the same as in `format_spec.md`.

Enumerations are the tuples of `nispcodec.asset` and `nispcodec.network`; on disk a member is its
position counted from 1, and 0 is reserved.
"""

from __future__ import annotations

SIGNATURE = b"\x89NSP\r\n\x1a\n"
MAJOR = 1
MINOR = 0

HEADER_SIZE = 16
ENTRY_SIZE = 24

CRITICAL = 1
PACKINGS = ("raw", "zstd")

INFO = "INFO"
META = "META"
NETS = "NETS"
TXTR = "TXTR"
CRITICAL_SECTIONS = frozenset({META, NETS, TXTR})
KNOWN_SECTIONS = CRITICAL_SECTIONS | {INFO}

MAX_SECTIONS = 64
MAX_FILE = 2**31 - 1
MAX_UNPACKED = 64 * 2**20
MAX_METADATA = 512 * 2**10
MAX_DEPTH = 8
MAX_ITEMS = 4096
MAX_TEXT = 1024
MAX_WEIGHTS = 2**23
MAX_SYMBOL = 2**23

NETWORKS = ("sdf", "chart", "uv")
CODINGS = ("dense", "coo", "csc", "csr", "dia", "entropy")
NUMBERS = ("float32", "float16", "int8", "int16", "int32")
