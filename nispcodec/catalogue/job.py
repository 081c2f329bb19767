"""A job: all that a worker needs to know to encode one asset."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from nispcodec.catalogue.plan import Asset
from nispcodec.catalogue.record import Record, failed
from nispcodec.catalogue.settings import Settings
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.progress import Listener
from nispcodec.encode.config import EncodeConfig
from nispcodec.model import NispModel

Encoder = Callable[[TexturedMesh, EncodeConfig, Listener], NispModel]
"""Mesh, how to encode it, who hears of progress; a function of a module, as it goes by its name."""


@dataclass(frozen=True)
class Job:
    """One asset to encode.

    asset      from where, and to where within `folder`
    folder     of the catalogue, a path or a URL
    settings   those of the batch with those of the asset
    threads    cores to compute on
    tries      how often it has been begun, this time included
    thumbnail  pixels of the pictures of original and decode, 0 for none
    compare    whether to measure the decode as `nisp compare` does
    earlier    what an earlier run left: if all is as it was, it is kept
    """

    asset: Asset
    folder: str
    settings: Settings
    threads: int = 1
    tries: int = 1
    thumbnail: int = 0
    compare: bool = False
    earlier: Record | None = None

    def failed(self, kind: str, error: str) -> Record:
        """The record of a job that came to nothing."""
        return failed(self.asset.source, self.asset.output, kind, error)


@dataclass(frozen=True)
class Result:
    """A record, and whether it is an earlier run's that was kept."""

    record: Record
    kept: bool = False
