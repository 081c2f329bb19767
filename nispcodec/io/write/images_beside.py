"""Images in files of their own, beside the mesh that names them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from nispcodec.core.asset import TexturedMesh
from nispcodec.io.write.names import image_names
from nispcodec.io.write.plain_images import MIMES, plain_image


@dataclass(frozen=True)
class ImagesBeside:
    """How a mesh's images are named, and whether they are there already."""

    names: list[str]
    shared: bool = False

    @staticmethod
    def of(mesh: TexturedMesh, stem: str, shared: bool = False) -> ImagesBeside:
        """Those that are named after a file of this stem, by number of the texture."""
        return ImagesBeside(image_names(stem, mesh.textures), shared)

    def files(self, mesh: TexturedMesh, used: Iterable[int]) -> dict[str, bytes]:
        """File name -> bytes of the textures in use; none where they are shared."""
        if self.shared:
            return {}
        return {self.names[each]: plain_image(mesh.textures[each], MIMES).data for each in used}
