"""Pictures of a model or a mesh from several views, by the same camera, lamp and shader."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.model import NispModel
from nispcodec.render.camera import Camera
from nispcodec.render.fragments import Scene
from nispcodec.render.maps import Maps
from nispcodec.render.parts import model_scene
from nispcodec.render.picture import Eye
from nispcodec.render.raycast import MeshScene


def scene_of(asset: NispModel | TexturedMesh | Scene, frame: Frame | None = None) -> Scene:
    """Something to render: a model's field is sphere-traced, triangles are hit by rays.

    `frame` places a mesh: that of the original, when the mesh is compared with it; by default its
    own. Making a scene takes time: keep it for several pictures. Raises MeshError for a mesh
    without a surface.
    """
    if isinstance(asset, NispModel):
        return model_scene(asset.document)
    return MeshScene(asset, frame) if isinstance(asset, TexturedMesh) else asset


def render_views(
    asset: NispModel | TexturedMesh | Scene,
    views: Iterable[Camera],
    size: int = 512,
    frame: Frame | None = None,
    normal_map: bool = True,
) -> list[Float32Array]:
    """One picture a view: (size, size, 4) float32 in [0, 1], sRGB-encoded RGB, straight alpha.

    Top row first; transparent where nothing is hit. `frame`: see `scene_of`. Raises MeshError for a
    mesh without a surface and for a texture that does not decode.
    """
    scene = scene_of(asset, frame)
    maps = Maps(scene.textures)
    return [Eye(scene, maps, view, size, normal_map).picture() for view in views]


def on_white(picture: Float32Array) -> Float32Array:
    """(h, w, 3) float32: a picture (h, w, 4) on white, mixed in sRGB as image viewers do."""
    alpha = picture[..., 3:]
    mixed: Float32Array = (picture[..., :3] * alpha + (1 - alpha)).astype(np.float32)
    return mixed
