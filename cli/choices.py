"""Lists to choose from: the library has them, and is asked when a subcommand needs them.

`nisp --help` builds the options of every command, and must not load the library for that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import click


class LibraryChoice(click.Choice[str]):
    """One of the names that a function gives, which is called at the first use."""

    def __init__(self, names: Callable[[], Iterable[str]]) -> None:
        self._names = names
        self.case_sensitive = True

    def __getattr__(self, name: str) -> Any:
        if name != "choices":
            raise AttributeError(name)
        self.choices = tuple(self._names())
        return self.choices

    def get_invalid_choice_message(self, value: Any, ctx: click.Context | None) -> str:
        """Of a value that is none of the names."""
        return f"expected one of {', '.join(self.choices)}, found {value!r}"


class Named(LibraryChoice):
    """Of names that this package has itself."""

    def __init__(self, *names: str) -> None:
        super().__init__(lambda: names)


def presets() -> Iterable[str]:
    """How long to learn."""
    from nispcodec.encode.config import PRESETS

    return PRESETS


def engines() -> Iterable[str]:
    """What trains."""
    from nispcodec.encode.config import ENGINES

    return ENGINES


def batch_engines() -> Iterable[str]:
    """Where the assets of a batch are encoded."""
    from nispcodec.catalogue.config import ENGINES

    return ENGINES


def texture_formats() -> Iterable[str]:
    """What the images of an asset can be made again as."""
    from nispcodec.encode.config import TEXTURE_FORMATS

    return TEXTURE_FORMATS


def image_formats() -> Iterable[str]:
    """What images can be made again as, whatever shows them."""
    from nispcodec.encode.config import IMAGE_FORMATS

    return IMAGE_FORMATS


def geometries() -> Iterable[str]:
    """What an asset may be held as."""
    from nispcodec.encode.config import GEOMETRIES

    return GEOMETRIES


def pruning_strategies() -> Iterable[str]:
    """How weights are chosen that are pruned."""
    from nispcodec.train.prune import STRATEGIES

    return STRATEGIES


def codings() -> Iterable[str]:
    """How weights are stored."""
    from nispcodec.format.codings.registry import CODINGS

    return CODINGS


def channels() -> Iterable[str]:
    """What a picture can show."""
    from nispcodec.render.channels import CHANNELS

    return CHANNELS


def views() -> Iterable[str]:
    """The views that have names."""
    from nispcodec.render.camera import NAMED

    return NAMED


def frames() -> Iterable[str]:
    """The frames of points and distances."""
    from nispcodec.model import FRAMES

    return FRAMES


def slots() -> Iterable[str]:
    """What a material uses an image for."""
    from nispcodec.core.slots import SLOTS

    return SLOTS


def mesh_suffixes() -> tuple[str, ...]:
    """Of the mesh files that can be written."""
    from nispcodec.io.save import SUFFIXES

    return SUFFIXES


def compressions() -> Iterable[str]:
    """How the geometry of a GLB can be made smaller."""
    from nispcodec.io.write.gltf_compression import COMPRESSIONS

    return COMPRESSIONS


def picture_suffixes() -> tuple[str, ...]:
    """Of the image files that can be written."""
    from nispcodec.render.images import SUFFIXES

    return SUFFIXES


def exact_picture_suffixes() -> tuple[str, ...]:
    """Of those, the ones that keep every color."""
    from nispcodec.render.images import EXACT

    return EXACT
