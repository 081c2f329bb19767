"""Settings: how one asset is to be encoded, and their hash."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

from nispcodec.core.errors import NispError
from nispcodec.encode.config import EncodeConfig

WITHOUT_EFFECT = ("threads",)
"""Members of `EncodeConfig` that change no byte."""
NAMES = ("unwrap", *(each.name for each in fields(EncodeConfig) if each.name not in WITHOUT_EFFECT))
"""What a manifest may say of an asset."""


@dataclass(frozen=True)
class Settings:
    """Everything that `nisp encode` is asked for and that changes its output.

    unwrap: new UVs first, as `nisp encode --unwrap` makes them.
    """

    encode: EncodeConfig = field(default_factory=EncodeConfig)
    unwrap: bool = False

    @property
    def options(self) -> dict[str, Any]:
        """Those that differ from the defaults, by name."""
        usual = _named(Settings())
        return {name: value for name, value in _named(self).items() if value != usual[name]}

    @property
    def digest(self) -> str:
        """SHA-256 of all members, so that a default that changes is another setting."""
        return hashlib.sha256(json.dumps(_named(self), sort_keys=True).encode()).hexdigest()

    def changed(self, options: Mapping[str, Any]) -> Settings:
        """These with some members of `NAMES` set; a text is read as what the member is.

        Raises NispError for an unknown name and for a value that a member cannot have.
        """
        if unknown := [name for name in options if name not in NAMES]:
            raise NispError(f"expected options of {', '.join(NAMES)}, found {unknown[0]!r}")
        typed = {name: _typed(name, value) for name, value in options.items()}
        unwrap = typed.pop("unwrap", self.unwrap)
        try:
            return Settings(replace(self.encode, **typed), unwrap)
        except TypeError as why:
            raise NispError(f"options: {why}") from why


def _named(settings: Settings) -> dict[str, Any]:
    members = {**asdict(settings.encode), "unwrap": settings.unwrap}
    return {name: members[name] for name in NAMES}


def _typed(name: str, value: object) -> Any:
    """The value as a member has it: in a table every value is text."""
    kind = "bool" if name == "unwrap" else str(_KINDS[name])
    try:
        if kind == "bool":
            return _truth(value)
        if isinstance(value, str) and kind.startswith("int"):
            return int(value)
        if kind.startswith("float") and not isinstance(value, Mapping | None):
            return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError) as why:
        raise NispError(f"{name}: expected {kind}, found {value!r}") from why
    if kind.startswith("str") and not isinstance(value, str | None):
        raise NispError(f"{name}: expected text, found {value!r}")
    return value


def _truth(value: object) -> bool:
    found = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}
    if isinstance(value, bool):
        return value
    if str(value).lower() not in found:
        raise ValueError(value)
    return found[str(value).lower()]


_KINDS = {each.name: each.type for each in fields(EncodeConfig)}
