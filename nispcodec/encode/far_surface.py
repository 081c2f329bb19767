"""Warnings of made-up and of lost surface, with place and size."""

from __future__ import annotations

from collections.abc import Iterator

from nispcodec.core.document import Document
from nispcodec.metrics.far_points import FAR, FarPoints, Place
from nispcodec.simplify.errors import Errors


def far_warnings(
    document: Document, errors: Errors, better: str | None, notable: float
) -> Iterator[str]:
    """A sentence for made-up surface and one for lost parts, each where its share is notable.

    With the place where most of it is and how large that is, in the asset's units. `better` is a
    preset that learns longer.
    """
    advice = _advice(document, better)
    for far, what in (
        (errors.made_up, "of the decoded surface is made up: nothing of the original"),
        (errors.lost, "of the original's surface is lost: nothing of the decoded surface"),
    ):
        if far.share > notable:
            limit = FAR * document.frame.radius
            yield (
                f"{_percent(far)} {what} is within {limit:.3g} of it; "
                f"most {_place(document, far.largest)}. {advice}"
            )


def _percent(far: FarPoints) -> str:
    return f"{100 * far.share:.3g} %"


def _place(document: Document, place: Place) -> str:
    radius = document.frame.radius
    x, y, z = document.frame.to_world(place.center)
    wide, high, deep = radius * place.extent
    where = f"about ({x:.3g}, {y:.3g}, {z:.3g}), {wide:.2g} x {high:.2g} x {deep:.2g} large"
    if len(document.materials) < 2 or place.material >= len(document.materials):
        return where
    return f"{where}, of material {document.materials[place.material].name!r}"


def _advice(document: Document, better: str | None) -> str:
    ways = ["--geometry mesh"] if document.field else []
    ways += [f"--preset {better}"] if better else []
    return f"Try {' or '.join(ways)}, and look at `nisp sheet`" if ways else "Look at `nisp sheet`"
