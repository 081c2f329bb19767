"""Thumbnails of an original and of what its networks hold, by one camera."""

from __future__ import annotations

from nispcodec.core.asset import TexturedMesh
from nispcodec.model import NispModel

ORIGINAL, DECODED = "original", "decoded"


def thumbnails(model: NispModel, mesh: TexturedMesh, size: int) -> dict[str, bytes]:
    """Pictures as WebP files, `size` pixels wide, by name; none for a size of 0.

    Raises MeshError as `nispcodec.render` does. Needs the extra `render`.
    """
    if not size:
        return {}
    from nispcodec.metrics.surface import frame_of
    from nispcodec.render.camera import view
    from nispcodec.render.images import image_bytes
    from nispcodec.render.views import render_views

    frame, camera = frame_of(mesh), [view("30,20")]
    drawn = {ORIGINAL: render_views(mesh, camera, size, frame)}
    drawn[DECODED] = render_views(model, camera, size)
    return {name: image_bytes(pictures, ".webp") for name, pictures in drawn.items()}
