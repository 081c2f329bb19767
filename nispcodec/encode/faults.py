"""Warnings of surface that is made up or lost, and of colors that are lost, with place and size."""

from __future__ import annotations

from collections.abc import Iterator

from nispcodec.core.document import Document
from nispcodec.metrics.faulty_points import FAR, FaultyPoints, Place
from nispcodec.simplify.errors import Errors


def fault_warnings(
    document: Document,
    errors: Errors,
    discolored: FaultyPoints,
    better: str | None,
    notable: float,
) -> Iterator[str]:
    """A sentence for made-up surface, one for lost parts, one for colors, where these are notable.

    With the place where most of it is and how large that is, in the asset's units. `better` is a
    preset that learns longer.
    """
    near = f"is within {FAR * document.frame.radius:.3g} of it"
    for faulty, what in (
        (errors.made_up, f"decoded surface is made up: nothing of the original {near}"),
        (errors.lost, f"original's surface is lost: nothing of the decoded surface {near}"),
        (discolored, "original's surface comes out in another color"),
    ):
        if faulty.share > notable:
            place = _place(document, faulty.largest)
            share, advice = f"{100 * faulty.share:.3g} %", _advice(document, better)
            yield f"{share} of the {what}; most {place}. {advice}"


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
