"""Many assets from Python: results as they come."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from nispcodec.catalogue.batch import Batch
from nispcodec.catalogue.config import BatchConfig
from nispcodec.catalogue.find import find_assets
from nispcodec.catalogue.job import Result
from nispcodec.catalogue.settings import Settings
from nispcodec.encode.config import EncodeConfig


def encode_many(
    inputs: str | Path | Iterable[str | Path],
    output: str | Path,
    config: EncodeConfig | None = None,
    batch: BatchConfig | None = None,
) -> Iterator[Result]:
    """See `nispcodec.encode_many`."""
    given = [inputs] if isinstance(inputs, str | Path) else inputs
    found = list(find_assets(os.fspath(each) for each in given))
    settings = Settings(config or EncodeConfig())
    yield from Batch(os.fspath(output), settings, batch or BatchConfig()).run(found)
