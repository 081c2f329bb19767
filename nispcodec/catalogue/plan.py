"""Words of a plan: the assets that are to be encoded, and what cannot be one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from hashlib import sha256
from typing import Any

from nispcodec.core.errors import NispError


@dataclass(frozen=True)
class Asset:
    """A mesh file that is to be encoded.

    source   its path or URL
    output   where it goes, relative to the folder of the catalogue, with slashes
    size     bytes of the mesh file, 0 where that is not known; large ones begin first
    options  of its own, over those of the whole batch
    """

    source: str
    output: str
    size: int = 0
    options: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Problem:
    """Something that was to be encoded and cannot be an asset: where, and a sentence."""

    source: str
    error: str


@dataclass(frozen=True)
class Shard:
    """Part `number` of `count`, from 1: the same assets whoever asks, whatever else there is.

    Raises NispError for a number that is not within the count.
    """

    number: int
    count: int

    def __post_init__(self) -> None:
        if not 1 <= self.number <= self.count:
            raise NispError(f"shard: expected 1/N to N/N, found {self.number}/{self.count}")

    def has(self, output: str) -> bool:
        """Whether the asset with this output is of the part."""
        digest = sha256(output.encode(errors="surrogateescape")).digest()
        return int.from_bytes(digest[:8]) % self.count == self.number - 1

    @property
    def suffix(self) -> str:
        """Ends the names of its files: `-3-of-8`."""
        return f"-{self.number}-of-{self.count}"


def told_apart(found: list[Asset | Problem]) -> tuple[list[Asset], list[Problem]]:
    """Assets with outputs of their own, in order of these, and all problems.

    Of several with one output the first is kept. One file found twice is one asset.
    """
    assets: dict[str, Asset] = {}
    problems = [each for each in found if isinstance(each, Problem)]
    for each in (each for each in found if isinstance(each, Asset)):
        first = assets.setdefault(each.output, each)
        if first.source != each.source:
            problems.append(
                Problem(
                    each.source,
                    f"expected an output of its own, found that {first.source} has it too "
                    f"({each.output}): name another in a manifest",
                )
            )
    return [assets[name] for name in sorted(assets)], problems
