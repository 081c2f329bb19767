"""`python -m nispcodec.train.backend.native` exits with 1, and says why, without a kernel."""

from __future__ import annotations

import sys

from nispcodec.train.backend.native.library import NativeError, library

try:
    library()
except NativeError as why:
    sys.exit(f"no native backend: {why}; training takes torch")
