"""The field of a document, for studies that are about networks."""

from __future__ import annotations

from nispcodec.core.document import Document, Field


def field_of(document: Document) -> Field:
    """The document's field. Raises ValueError where the asset is held as meshes alone."""
    if document.field is None:
        raise ValueError(
            "expected a file with networks, found meshes alone: encode --geometry field"
        )
    return document.field
