"""The base colors of an asset, its images decoded once: many decodes are compared with it."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, Uint8Array
from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.core.texture import base_colors_of, image_bytes
from nispcodec.metrics.geometry import Matches
from nispcodec.metrics.surface import Surface, SurfacePoints
from nispcodec.metrics.uv import uv_at


@dataclass(frozen=True)
class Paint:
    """Materials, and the pixels (h, w, 4) uint8 of their base colors by the number of the texture.

    Materials whose image does not decode show their factor alone.
    """

    materials: tuple[Material, ...]
    images: Mapping[int, Uint8Array]

    @staticmethod
    def of(mesh: TexturedMesh) -> Paint:
        """That of an asset."""
        images: dict[int, Uint8Array] = {}
        for material in mesh.materials:
            used = material.maps.get("base_color")
            if used and used.texture not in images:
                with suppress(MeshError):
                    images[used.texture] = image_bytes(mesh.textures[used.texture])
        return Paint(mesh.materials, images)

    def misses(self, original: Surface, decoded: Surface, matches: Matches) -> Float64Array:
        """(n,): mean squares over R, G and B of what the colors of pairs differ by, sRGB-encoded.

        Faces of both surfaces have the numbers of these materials.
        """
        found: Float64Array = np.square(self.differences(original, decoded, matches)).mean(axis=1)
        return found

    def differences(self, original: Surface, decoded: Surface, matches: Matches) -> Float64Array:
        """(n, 3): by how much the decoded colors of pairs are above the original's, as `misses`."""
        first, second = self._at(original, matches.original), self._at(decoded, matches.decoded)
        return second.astype(np.float64) - first

    def _at(self, surface: Surface, points: SurfacePoints) -> Float32Array:
        mesh, faces = surface.mesh, points.faces
        owners = mesh.face_materials[faces]
        pictured = np.array([self._is_pictured(each) for each in self.materials], np.bool_)
        has_uv = mesh.has_uv[faces] & pictured[owners]
        uvs = uv_at(surface, points)
        return base_colors_of(self.materials, self.images.__getitem__, owners, has_uv, uvs)[:, :3]

    def _is_pictured(self, material: Material) -> bool:
        used = material.maps.get("base_color")
        return used is not None and used.texture in self.images
