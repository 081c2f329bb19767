"""Bytes: document <-> container. The normative text is `format_spec.md`."""

from __future__ import annotations

from nispcodec.format.document import SectionInfo, inspect, own_bytes, pack, unpack
from nispcodec.format.file import read

__all__ = ["SectionInfo", "inspect", "own_bytes", "pack", "read", "unpack"]
