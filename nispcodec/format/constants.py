"""Names and numbers of the container, version 1: the same as in `format_spec.md`.

Enumerations are the tuples here and those of `nispcodec.core.asset`, `nispcodec.core.network` and
`nispcodec.format.codings.registry`; on disk a member is its position counted from 1, and 0 is
reserved.
"""

from __future__ import annotations

SIGNATURE = b"\x89NSP\r\n\x1a\n"
MAJOR = 1
MINOR = 0

HEADER_SIZE = 16
ENTRY_SIZE = 21
CRITICAL = 1
PACKED = 2

MESH = "MESH"
META = "META"
NETS = "NETS"
TXTR = "TXTR"
SECTIONS = (MESH, META, NETS, TXTR)

NETWORKS = ("sdf", "chart", "uv")
MEASURES = (
    "preset",
    "seed",
    "hidden_share",
    "open_surface_share",
    "distance_error",
    "chart_accuracy",
    "uv_error_median",
    "uv_error_mean",
    "other_form_bytes",
    "made_up_share",
    "lost_share",
)
PRESETS = ("balanced", "paper", "fast", "best")
STEPS = ("byte", "float16", "float32", "same", "rows1", "rows2", "rows3")
NUMBERS = ("float32", "float16", "int8", "int16", "int32")
ENDINGS = (".png", ".jpg", ".webp", ".avif")

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
MAX_CELLS = 256
MAX_MESH_FACES = 2**18
MESH_FACES_PER_BYTE = 64
MAX_MESH_PLACEMENTS = 4096
