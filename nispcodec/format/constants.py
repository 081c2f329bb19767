"""Names and numbers of the container, version 1: the same as in `format_spec.md`.

Enumerations are the tuples here and those of `nispcodec.asset` and `nispcodec.network`; on disk a
member is its position counted from 1, and 0 is reserved.
"""

from __future__ import annotations

SIGNATURE = b"\x89NSP\r\n\x1a\n"
MAJOR = 1
MINOR = 0

HEADER_SIZE = 16
ENTRY_SIZE = 24
CRITICAL = 1
QUANTISED = 0x80
SHORT_STEP = 0x40

INFO = "INFO"
META = "META"
NETS = "NETS"
TXTR = "TXTR"
CRITICAL_SECTIONS = (META, NETS, TXTR)
KNOWN_SECTIONS = (INFO, META, NETS, TXTR)

PACKINGS = ("raw", "zstd")
NETWORKS = ("sdf", "chart", "uv")
CODINGS = ("dense", "coo", "csc", "csr", "dia", "entropy")
NUMBERS = ("float32", "float16", "int8", "int16", "int32")

MAX_SECTIONS = 64
MAX_FILE = 2**31 - 1
MAX_UNPACKED = 32 * 2**20
MAX_METADATA = 256 * 2**10
MAX_DEPTH = 8
MAX_ITEMS = 4096
MAX_VALUES = 16_384
MAX_TEXT = 1024
MAX_WEIGHTS = 2**20
MAX_MEMORY = 96 * 2**20
MAX_SYMBOL = 2**23 - 1
MAX_TOKENS = 62

# Relative frequencies of tokens in half-octave steps: four bits say them within 20 percent.
LEVELS = (0, 1, 2, 3, 4, 6, 8, 11, 16, 23, 32, 45, 64, 91, 128, 181)
