"""The content of a Draco stream, by the library DracoPy; for `decode_apart` alone."""

from __future__ import annotations

from nispcodec.core.arrays import AnyArray

FACES = "faces"


def decode_draco(data: bytes) -> dict[str, AnyArray]:
    """The faces (m, 3), and each attribute (n, width) by its unique id in digits.

    Raises what DracoPy raises for other data; ValueError for a point cloud.
    """
    import DracoPy

    mesh = DracoPy.decode(data)
    faces = getattr(mesh, "faces", None)
    if faces is None:
        raise ValueError("a point cloud")
    attributes = {str(each["unique_id"]): each["data"] for each in mesh.attributes}
    return {FACES: faces, **attributes}
