"""A scene that is seen more than once from the same places: its rays are cast once."""

from __future__ import annotations

import hashlib

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import Material, Texture
from nispcodec.core.document import Frame
from nispcodec.render.fragments import Cast, Scene


class RememberedScene:
    """A scene that keeps what its rays hit, and may be seen with other textures.

    What is kept takes some 100 bytes a ray that hits.
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._textures = scene.textures
        self._casts: dict[bytes, Cast] = {}

    def with_textures(self, textures: tuple[Texture, ...]) -> RememberedScene:
        """The same surface with other images; both remember what either casts."""
        other = RememberedScene(self._scene)
        other._textures, other._casts = textures, self._casts
        return other

    @property
    def frame(self) -> Frame:
        """The scene's frame."""
        return self._scene.frame

    @property
    def materials(self) -> tuple[Material, ...]:
        """The scene's materials."""
        return self._scene.materials

    @property
    def textures(self) -> tuple[Texture, ...]:
        """The images that it is seen with."""
        return self._textures

    def cast(self, origins: Float32Array, directions: Float32Array, layer: int) -> Cast:
        """Cast rays (n, 3), (n, 3), or recall what they hit; see `Scene.cast`."""
        rays = hashlib.sha256(origins.tobytes() + directions.tobytes() + bytes([layer])).digest()
        if rays not in self._casts:
            self._casts[rays] = self._scene.cast(origins, directions, layer)
        return self._casts[rays]
